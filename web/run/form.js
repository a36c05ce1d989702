/** A form made from a JSON schema; texts that cannot be used stay in their field with the reason beside it. */
import { get, set, useStore } from "../store.js";
import { unitSign } from "../units.js";
import { html, useEffect, useId, useState } from "../view.js";
import { fieldsOf, parse, rangeOf, show } from "./schema.js";

/** @param props section: prefix of error keys; schema; values; onChange(name, value); children: further fields */
export function SchemaForm({ section, schema, values, onChange, children }) {
  return html`
    <div class="fields">
      ${fieldsOf(schema).map((form) => html`
        <${Field} key=${`${section}.${form.name}`} id=${`${section}.${form.name}`} form=${form}
          value=${form.name in values ? values[form.name] : form.initial} onChange=${(value) => onChange(form.name, value)} />
      `)}
      ${children}
    </div>
  `;
}

const CONTROLS = { choice: Choice, switch: Switch, points: Points, number: Entry, text: Entry };

export function Field({ id, form, value, onChange }) {
  const own = useId();
  const error = useStore((state) => state.draftErrors[id] ?? state.serverErrors[id] ?? "");
  useEffect(() => () => setDraftError(id, ""), [id]);
  const hint = [form.description, rangeOf(form) && `Range: ${rangeOf(form)}.`, defaultHint(form)].filter(Boolean).join(" ");
  const control = {
    id: own, form, value, onChange, invalid: Boolean(error),
    describedBy: `${own}-hint ${own}-error`, refuse: (text) => setDraftError(id, text),
  };
  return html`
    <div class=${`field field-${form.kind}`} title=${hint}>
      <label for=${own}>${form.title}${form.kind === "points" && form.unit ? `, ${form.unit}` : ""}</label>
      <${CONTROLS[form.kind]} ...${control} />
      <span class="unseen" id=${`${own}-hint`}>${hint}</span>
      <p class="field-error" id=${`${own}-error`} aria-live="polite">${error}</p>
    </div>
  `;
}

function defaultHint(form) {
  if (form.initial === undefined || form.initial === null || form.kind === "points") return "";
  return `Default: ${show(form.initial, form)}${form.unit ? ` ${unitSign(form.unit)}` : ""}.`;
}

function setDraftError(id, text) {
  const { [id]: before, ...others } = get().draftErrors;
  if ((before ?? "") === text) return;
  set({ draftErrors: text ? { ...others, [id]: text } : others });
}

/** What is typed, until it says the same as the value; then the value speaks. */
function useDraft({ form, value, onChange, refuse }) {
  const [draft, setDraft] = useState(null);
  const type = (text) => {
    const { value: next, error } = parse(text, form);
    setDraft(text);
    refuse(error ?? "");
    if (!error) onChange(next);
  };
  const settle = () => {
    if (draft !== null && !parse(draft, form).error) setDraft(null);
  };
  return { text: draft ?? show(value, form), type, settle };
}

function Entry(props) {
  const { text, type, settle } = useDraft(props);
  const { id, form, invalid, describedBy } = props;
  const unit = unitSign(form.unit);
  return html`
    <span class="entry">
      <input id=${id} type="text" inputmode=${form.kind === "number" ? "decimal" : "text"} autocomplete="off"
        value=${text} aria-invalid=${invalid} aria-describedby=${describedBy}
        onInput=${(event) => type(event.target.value)} onBlur=${settle} />
      ${unit && html`<span class="unit">${unit}</span>`}
    </span>
  `;
}

function Points(props) {
  const { text, type, settle } = useDraft(props);
  const { id, invalid, describedBy } = props;
  return html`<textarea id=${id} rows="4" spellcheck=${false} value=${text} aria-invalid=${invalid} aria-describedby=${describedBy}
    placeholder="x, y in mm: one point a line" onInput=${(event) => type(event.target.value)} onBlur=${settle}></textarea>`;
}

function Switch({ id, value, onChange, describedBy }) {
  return html`<input id=${id} type="checkbox" checked=${Boolean(value)} aria-describedby=${describedBy}
    onChange=${(event) => onChange(event.target.checked)} />`;
}

function Choice({ id, form, value, onChange, describedBy }) {
  return html`
    <select id=${id} aria-describedby=${describedBy} onChange=${(event) => onChange(form.choices[event.target.selectedIndex])}>
      ${form.choices.map((choice) => html`<option selected=${choice === value}>${show(choice, form)}</option>`)}
    </select>
  `;
}
