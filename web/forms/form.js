/** A form made from a JSON schema; texts that cannot be used stay in their field with the reason beside it. */
import { HelpButton } from "../help/button.js";
import { useStore } from "../store.js";
import { unitSign } from "../units.js";
import { html, useEffect, useId } from "../view.js";
import { Choice, NumberEntry, Points, Switch, TextEntry } from "./controls.js";
import { setDraftError } from "./draft.js";
import { fieldsOf, rangeOf, show } from "./schema.js";

/** @typedef {import("./schema.js").Form} Form */
/**
 * What becomes of a value while something goes on that it belongs to.
 * @typedef {{state: "pending" | "applied" | "waits" | "quiet", words: string}} Standing quiet: said only beneath a field in use
 */

/**
 * @param {Object} props
 * @param {string} props.section prefix of the keys of errors, "gait"
 * @param {string} [props.of] whose parameters they are, for the help: "controller.geometric"; as the section unless given
 * @param {any} props.schema
 * @param {Object} props.values
 * @param {(name: string, value: any) => void} props.onChange
 * @param {(form: Form) => Standing | null} [props.standingOf]
 * @param {boolean} [props.locked] to be read, not changed
 * @param {any} [props.children] further fields
 */
export function SchemaForm({ section, of = section, schema, values, onChange, standingOf = () => null, locked = false, children = null }) {
  return html`
    <div class="fields">
      ${fieldsOf(schema).map((form) => html`
        <${Field} key=${`${of}.${form.name}`} id=${`${section}.${form.name}`} of=${of} form=${form} locked=${locked} standing=${standingOf(form)}
          value=${form.name in values ? values[form.name] : form.initial} onChange=${(value) => onChange(form.name, value)} />
      `)}
      ${children}
    </div>
  `;
}

const CONTROLS = { choice: Choice, switch: Switch, points: Points, number: NumberEntry, text: TextEntry };

/**
 * @param {Object} props
 * @param {string} props.id key of its errors in the store, "gait.sweep_deg"
 * @param {string} [props.of] for the help
 * @param {Form} props.form
 * @param {any} props.value
 * @param {(value: any) => void} props.onChange
 * @param {boolean} [props.locked]
 * @param {Standing | null} [props.standing]
 */
export function Field({ id, of = "", form, value, onChange, locked = false, standing = null }) {
  const own = useId();
  const texts = useStore((state) => ({ refused: state.draftErrors[id] ?? "", server: state.serverErrors[id] ?? "" }));
  const { refused } = texts;
  const error = refused || texts.server;
  useEffect(() => () => setDraftError(id, ""), [id]);
  const control = {
    id: own, form, value, onChange, invalid: Boolean(error), refused: refused !== "",
    describedBy: `${own}-note ${own}-standing ${own}-error`, refuse: (text) => setDraftError(id, text),
  };
  const note = noteOf(form, standing);
  const reset = () => {
    setDraftError(id, "");
    onChange(form.initial);
  };
  return html`
    <div class=${`field field-${form.kind}`}>
      <div class="field-title">
        <label for=${own}>${form.title}${form.kind === "points" && form.unit ? `, ${form.unit}` : ""}</label>
        <${HelpButton} of=${of} form=${form} />
        <${Reset} form=${form} changed=${!locked && (refused !== "" || !isSame(value, form.initial))} reset=${reset} />
      </div>
      <fieldset role="presentation" disabled=${locked}><${CONTROLS[form.kind] ?? TextEntry} ...${control} /></fieldset>
      <p class="field-note" id=${`${own}-note`}>${note}</p>
      <p class="field-standing" id=${`${own}-standing`} data-state=${standing?.state} aria-live="polite">${standing && standing.state !== "quiet" && standing.words}</p>
      <p class="field-error" id=${`${own}-error`} aria-live="polite">${error}</p>
    </div>
  `;
}

/** Under the field while one is in it: what is allowed, and what it is unless changed. */
function noteOf(form, standing) {
  const parts = [rangeOf(form), defaultOf(form), standing?.state === "quiet" ? standing.words : ""].filter(Boolean);
  const facts = parts.join(" · ");
  return form.description ? html`${form.description}${facts && html`<span class="field-facts">${facts}</span>`}` : facts;
}

function defaultOf(form) {
  if (form.initial === undefined || form.initial === null || form.kind === "points") return form.optional ? "may be empty" : "";
  return `default ${inWords(form.initial, form)}`;
}

function inWords(value, form) {
  if (form.kind === "switch") return value ? "on" : "off";
  const sign = unitSign(form.unit);
  return `${show(value, form)}${sign === "°" || sign === "" ? sign : ` ${sign}`}`;
}

/** The rig keeps SI: a number in degrees comes back with its last digits rounded. */
const ROUNDED = 1e-4;

function isSame(a, b) {
  if (typeof a === "number" && typeof b === "number") return Math.abs(a - b) <= ROUNDED * Math.abs(b);
  return JSON.stringify(a ?? null) === JSON.stringify(b ?? null);
}

/** There only while there is something to take back. */
function Reset({ form, changed, reset }) {
  if (form.initial === undefined || !changed) return null;
  const to = form.initial === null || form.kind === "points" ? "its default" : inWords(form.initial, form);
  return html`<button class="reset" type="button" aria-label=${`Reset ${form.title.toLowerCase()} to ${to}`} title=${`Back to ${to}`} onClick=${reset}>↺</button>`;
}
