/** What the study varies: a row an axis, with its values as a list or from, to and step. */
import { unitSign } from "../units.js";
import { html, useId } from "../view.js";
import { allAxes, firstValues } from "./axis_choices.js";
import { setAxes, useDraft } from "./composing.js";
import { RANGED, textOfValues, valuesOf } from "./draft.js";
import { Select, TextField, useProblem } from "./entry.js";
import { valueText } from "./words.js";

export function AxisRows({ groups }) {
  const { axes, rest } = useDraft((draft) => draft);
  const problem = useProblem(["axes"]);
  const free = allAxes(groups).filter(({ name }) => !axes.some(({ of }) => of === name));
  const add = () => setAxes([...axes, newRow(free[0], rest.design)]);
  const put = (index, row) => setAxes(axes.map((other, place) => (place === index ? row : other)));
  const drop = (index) => setAxes(axes.filter((_, place) => place !== index));
  return html`
    <fieldset class="axes">
      <legend>What varies</legend>
      ${axes.map((row, index) => html`<${Row} key=${`${index} ${row.of} ${row.how}`} row=${row} index=${index} groups=${groups} taken=${axes.map(({ of }) => of)} design=${rest.design} put=${(next) => put(index, next)} drop=${() => drop(index)} />`)}
      ${axes.length === 0 && html`<p class="field-error" aria-live="polite">${problem}</p>`}
      <button type="button" disabled=${free.length === 0} onClick=${add}>Add an axis</button>
    </fieldset>
  `;
}

function newRow(axis, design) {
  const values = firstValues(axis);
  const ranged = RANGED.includes(design) && axis.kind === "number";
  return { of: axis.name, how: ranged ? "range" : "values", values, from: ranged ? String(values[0]) : "", to: ranged ? String(values.at(-1)) : "", step: "" };
}

function Row({ row, index, groups, taken, design, put, drop }) {
  const id = useId();
  const axis = allAxes(groups).find(({ name }) => name === row.of) ?? { name: row.of, title: row.of, unit: "", kind: "text", choices: [] };
  const problem = useProblem(["axes", index]);
  const pick = (event) => put(newRow(allAxes(groups).find(({ name }) => name === event.target.value), design));
  return html`
    <div class="axis-row" role="group" aria-label=${`Axis ${index + 1}`}>
      <div class="field"><label for=${id}>Axis</label>
        <select id=${id} onChange=${pick}>
          ${!allAxes(groups).includes(axis) && html`<option value=${row.of} selected>${row.of}</option>`}
          ${groups.map(({ title, axes }) => html`<optgroup label=${title}>${axes.map(({ name, title: words }) => html`<option value=${name} selected=${name === row.of} disabled=${name !== row.of && taken.includes(name)}>${words}</option>`)}</optgroup>`)}
        </select>
      </div>
      ${axis.kind === "choice" ? html`<${Ticks} axis=${axis} row=${row} put=${put} design=${design} />` : html`<${Numbers} axis=${axis} row=${row} put=${put} design=${design} />`}
      <button class="quiet" type="button" aria-label=${`Remove ${axis.title}`} title="Remove" onClick=${drop}>×</button>
      <p class="field-error" aria-live="polite">${problem}</p>
      ${axis.range && html`<p class="hint">Allowed: ${axis.range}.</p>`}
    </div>
  `;
}

const HOW = [["values", "values"], ["range", "from – to"]];

function Numbers({ axis, row, put, design }) {
  const turn = (how) => put({ ...row, how });
  return html`
    ${design !== "list" && html`<${Select} title="Given as" options=${HOW} value=${row.how} choose=${turn} />`}
    ${row.how === "values"
      ? html`<div class="axis-values"><${TextField} title=${`Values${unitSign(axis.unit) ? ` in ${unitSign(axis.unit)}` : ""}`} kind="text" initial=${textOfValues(row.values)} type=${(text) => put({ ...row, values: valuesOf(text) })} /></div>`
      : html`
        <${TextField} title="From" unit=${axis.unit} initial=${row.from} type=${(from) => put({ ...row, from })} />
        <${TextField} title="To" unit=${axis.unit} initial=${row.to} type=${(to) => put({ ...row, to })} />
        <${TextField} title="Step" unit=${axis.unit} initial=${row.step} placeholder=${RANGED.includes(design) ? "none" : ""} type=${(step) => put({ ...row, step })} />`}
  `;
}

/** Words are ticked; in a list of sets they are written, since one may stand there twice. */
function Ticks({ axis, row, put, design }) {
  if (design === "list") return html`<div class="axis-values"><${TextField} title="Values" kind="text" initial=${textOfValues(row.values)} type=${(text) => put({ ...row, values: valuesOf(text) })} /></div>`;
  const turn = (value, on) => put({ ...row, how: "values", values: axis.choices.filter((each) => (each === value ? on : row.values.includes(each))) });
  return html`
    <div class="axis-ticks" role="group" aria-label=${axis.title}>
      ${axis.choices.map((value) => html`<${Tick} value=${value} on=${row.values.includes(value)} turn=${turn} />`)}
    </div>
  `;
}

/** The space bar is STOP, so Enter ticks. */
function Tick({ value, on, turn }) {
  const press = (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    turn(value, !on);
  };
  return html`<label class="switch"><input type="checkbox" checked=${on} onChange=${(event) => turn(value, event.target.checked)} onKeyDown=${press} />${valueText(value)}</label>`;
}
