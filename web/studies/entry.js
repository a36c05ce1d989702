/** Fields of the form: a label, the unit, and beside it what the server says is wrong. */
import { unitSign } from "../units.js";
import { html, useId, useState } from "../view.js";
import { setField, useDraft } from "./composing.js";
import { fieldAt, numberOf } from "./draft.js";

/** What is wrong with a field, or with anything inside it. */
export function useProblem(path) {
  const field = path.join(".");
  return useDraft(({ problems }) => Object.entries(problems).find(([name]) => name === field || name.startsWith(`${field}.`))?.[1] ?? "") ?? "";
}

/** @param props path in the definition; title; unit; hint; kind: "number" or "text"; placeholder: what holds when it is empty */
export function Entry({ path, title, unit = "", hint = "", kind = "number", placeholder = "" }) {
  const rest = useDraft((draft) => draft.rest);
  const type = (text) => setField(path, kind === "number" ? numberOf(text) : text);
  return html`<${TextField} title=${title} unit=${unit} hint=${hint} kind=${kind} placeholder=${placeholder} problem=${useProblem(path)} initial=${fieldAt(rest, path)} type=${type} />`;
}

/** What is typed stays as it is typed. */
export function TextField({ title, unit = "", hint = "", kind = "number", placeholder = "", problem = "", initial, type, labelled = true }) {
  const id = useId();
  const [text, setText] = useState(initial === undefined || initial === null ? "" : String(initial));
  const sign = unitSign(unit);
  const input = (event) => {
    setText(event.target.value);
    type(event.target.value);
  };
  return html`
    <div class="field" title=${hint}>
      <label class=${labelled ? "" : "unseen"} for=${id}>${title}</label>
      <span class="entry">
        <input id=${id} type="text" inputmode=${kind === "number" ? "decimal" : "text"} autocomplete="off" value=${text} placeholder=${placeholder}
          aria-invalid=${Boolean(problem)} aria-describedby=${`${id}-error`} onInput=${input} />
        ${sign && html`<span class="unit">${sign}</span>`}
      </span>
      <p class="field-error" id=${`${id}-error`} aria-live="polite">${problem}</p>
    </div>
  `;
}

/** options: [[value, words], …] */
export function Select({ title, options, value, choose, hint = "", problem = "" }) {
  const id = useId();
  return html`
    <div class="field" title=${hint}>
      <label for=${id}>${title}</label>
      <select id=${id} aria-describedby=${`${id}-error`} onChange=${(event) => choose(options[event.target.selectedIndex][0])}>
        ${options.map(([each, words]) => html`<option selected=${each === value}>${words}</option>`)}
      </select>
      <p class="field-error" id=${`${id}-error`} aria-live="polite">${problem}</p>
    </div>
  `;
}

export function Choice({ path, title, options, hint }) {
  const rest = useDraft((draft) => draft.rest);
  return html`<${Select} title=${title} options=${options} hint=${hint} value=${fieldAt(rest, path)} problem=${useProblem(path)} choose=${(value) => setField(path, value)} />`;
}
