/** Values that may change while the robot walks: sent to the run that goes on as soon as typing pauses. */
import { report } from "../live/actions.js";
import { patch, Problem } from "../live/rest.js";
import { select, sendSelection } from "../live/selection.js";
import { get, set } from "../store.js";
import { isOccupied } from "../studies/listing.js";
import { isSameChoice } from "./standing.js";

/** Before the selection itself is sent, which this does as well, ms. */
const PAUSE_MS = 250;

/** Part -> name -> value, of what has been changed since it was last sent. @type {Record<string, Record<string, any>>} */
let waiting = {};
let timer = 0;

/**
 * Changes one value of the selection, and of the run that goes on where the schema says that it is safe.
 * @param {"controller" | "trajectory" | "gait"} part
 * @param {import("../forms/schema.js").Form} form
 * @param {any} value
 */
export function edit(part, form, value) {
  const { walked } = get();
  const selection = /** @type {import("../types").Selection} */ (get().selection);
  const before = /** @type {any} */ (selection[part]);
  const parameters = { ...(part === "gait" ? before : before.parameters), [form.name]: value };
  select({ [part]: part === "gait" ? parameters : { ...before, parameters } });
  if (!walked || !form.live || isOccupied(get()) || !isSameChoice(selection, walked, part)) return;
  waiting[part] = { ...waiting[part], [form.name]: value };
  mark([`${part}.${form.name}`], "pending");
  clearTimeout(timer);
  timer = setTimeout(send, PAUSE_MS);
}

async function send() {
  const sent = waiting;
  waiting = {};
  const ids = Object.entries(sent).flatMap(([part, values]) => Object.keys(values).map((name) => `${part}.${name}`));
  try {
    await sendSelection();
    const run = await patch("/runs/current", bodyOf(sent));
    // The stream tells the same; whichever comes first is shown.
    if (get().walked?.id === run.id) set({ walked: run });
    mark(ids, "applied");
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    mark(ids, null);
    refuse(ids, problem);
  }
}

/** @param {Record<string, any>} sent */
const bodyOf = ({ gait, ...parts }) => ({
  ...Object.fromEntries(Object.entries(parts).map(([part, parameters]) => [part, { parameters }])),
  ...(gait ? { gait } : {}),
});

/** Beside the fields that were sent, unless the server names others. */
function refuse(ids, problem) {
  if (Object.keys(problem.fields).length > 0) report(problem);
  else set({ serverErrors: { ...get().serverErrors, ...Object.fromEntries(ids.map((id) => [id, problem.message])) } });
}

/** What was changed again meanwhile stays on its way. */
function mark(ids, state) {
  const applying = { ...get().applying };
  for (const id of ids) {
    const [part, name] = id.split(".");
    if (state !== "pending" && name in (waiting[part] ?? {})) continue;
    if (state === null) delete applying[id];
    else applying[id] = state;
  }
  set({ applying });
}
