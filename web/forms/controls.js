/** The controls of a form, one a kind of field; each tells its value at once and keeps what cannot be used yet. */
import { unitSign } from "../units.js";
import { html } from "../view.js";
import { useDraft } from "./draft.js";
import { show } from "./schema.js";
import { stepped, stepsOfKey } from "./stepping.js";

/** @param {any} props id, form, value, onChange, invalid, describedBy, refuse */
export function NumberEntry(props) {
  const { id, form, value, invalid, describedBy } = props;
  const { text, type, settle, put } = useDraft(props);
  const unit = unitSign(form.unit);
  const move = (count) => put(stepped(form, typeof value === "number" ? value : null, count));
  const press = (event) => {
    const count = stepsOfKey(event);
    if (count === 0) return;
    event.preventDefault();
    move(count);
  };
  return html`
    <span class="entry stepped">
      <${Step} sign="−" move=${() => move(-1)} />
      <input id=${id} type="text" inputmode="decimal" autocomplete="off" value=${text} placeholder=${form.placeholder ?? ""}
        aria-invalid=${invalid} aria-describedby=${describedBy}
        onInput=${(event) => type(event.target.value)} onBlur=${settle} onKeyDown=${press} />
      ${unit && html`<span class="unit">${unit}</span>`}
      <${Step} sign="+" move=${() => move(1)} />
    </span>
    ${form.usual && html`<${Slider} ...${props} put=${put} />`}
  `;
}

/** For the mouse and the finger alone: the keyboard has the arrows, and who hears the page has the field itself. */
const Step = ({ sign, move }) => html`<button class="step-by" type="button" tabindex="-1" aria-hidden="true" onClick=${move}>${sign}</button>`;

/** Over the usual part of the range; the entry takes the rest. */
function Slider({ form, value, put }) {
  const [low, high] = form.usual;
  return html`<input class="slider" type="range" tabindex="-1" aria-label=${`${form.title}, slider`} min=${low} max=${high} step=${form.step ?? "any"}
    value=${typeof value === "number" ? value : low} onInput=${(event) => put(Number(event.target.value))} />`;
}

/** @param {any} props */
export function TextEntry(props) {
  const { text, type, settle } = useDraft(props);
  const { id, form, invalid, describedBy } = props;
  return html`
    <span class="entry">
      <input id=${id} type="text" autocomplete="off" value=${text} placeholder=${form.placeholder ?? ""} aria-invalid=${invalid} aria-describedby=${describedBy}
        onInput=${(event) => type(event.target.value)} onBlur=${settle} />
      ${unitSign(form.unit) && html`<span class="unit">${unitSign(form.unit)}</span>`}
    </span>
  `;
}

/** @param {any} props */
export function Points(props) {
  const { text, type, settle } = useDraft(props);
  const { id, invalid, describedBy } = props;
  return html`<textarea id=${id} rows="4" spellcheck=${false} value=${text} aria-invalid=${invalid} aria-describedby=${describedBy}
    placeholder="x, y in mm: one point a line" onInput=${(event) => type(event.target.value)} onBlur=${settle}></textarea>`;
}

/** @param {any} props The space bar is STOP, so Enter turns it. */
export function Switch({ id, value, onChange, invalid, describedBy }) {
  const press = (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    onChange(!value);
  };
  return html`<input id=${id} type="checkbox" checked=${Boolean(value)} aria-invalid=${invalid} aria-describedby=${describedBy}
    onChange=${(event) => onChange(event.target.checked)} onKeyDown=${press} />`;
}

/** @param {any} props */
export function Choice({ id, form, value, onChange, invalid, describedBy }) {
  return html`
    <select id=${id} aria-invalid=${invalid} aria-describedby=${describedBy} onChange=${(event) => onChange(form.choices[event.target.selectedIndex])}>
      ${form.choices.map((choice) => html`<option selected=${choice === value}>${show(choice, form)}</option>`)}
    </select>
  `;
}
