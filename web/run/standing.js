/** What a value of the run panel is to the run that goes on: in it, on its way, or for the next one. Pure. */
import { show } from "../forms/schema.js";
import { unitSign } from "../units.js";

/** @typedef {import("../forms/schema.js").Form} Form */
/** @typedef {import("../forms/form.js").Standing} Standing */

/** The parameters of a part, which of the gait are the part itself. */
export const parametersOf = (selection, part) => (part === "gait" ? selection.gait : selection[part].parameters);

const same = (a, b) => JSON.stringify(a ?? null) === JSON.stringify(b ?? null);

/** Whether a part of the selection is of the same kind as that of the run: the same controller, the same path. */
export const isSameChoice = (selection, walked, part) => part === "gait" || selection[part].name === walked[part].name;

/**
 * @param {Object} now
 * @param {any} now.selection
 * @param {any} now.walked the run that goes on, or null
 * @param {boolean} now.occupied a study has the rig, and its runs are its own
 * @param {Record<string, "pending" | "applied">} now.applying
 * @param {string} part "controller", "trajectory" or "gait"
 * @param {Form} form
 * @returns {Standing | null}
 */
export function standingOf({ selection, walked, occupied, applying }, part, form) {
  if (!walked) return null;
  const [chosen, inRun] = [parametersOf(selection, part)[form.name], parametersOf(walked, part)[form.name]];
  const waits = occupied || !form.live || !isSameChoice(selection, walked, part);
  if (waits) return !isSameChoice(selection, walked, part) || same(chosen, inRun) ? quiet("a change is for the next run") : { state: "waits", words: "for the next run" };
  const sent = applying[`${part}.${form.name}`];
  if (sent === "pending") return { state: "pending", words: "sending…" };
  if (!same(chosen, inRun)) return { state: "waits", words: `this run has ${valueWords(inRun, form)}` };
  return sent === "applied" ? { state: "applied", words: "in this run" } : quiet("applies at once");
}

const quiet = (words) => /** @type {Standing} */ ({ state: "quiet", words });

function valueWords(value, form) {
  if (value === null || value === undefined) return "none";
  if (form.kind === "switch") return value ? "it on" : "it off";
  const sign = unitSign(form.unit);
  return `${show(value, form)}${sign === "°" || sign === "" ? sign : ` ${sign}`}`;
}

/** Whether anything of the selection is not in the run. */
export const somethingWaits = (selection, walked) =>
  ["controller", "trajectory", "gait"].some((part) =>
    !isSameChoice(selection, walked, part) || !same(sorted(parametersOf(selection, part)), sorted(parametersOf(walked, part))));

const sorted = (parameters) => Object.entries(parameters).sort(([a], [b]) => (a < b ? -1 : 1));
