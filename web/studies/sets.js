/** Every set in numbers; the headings sort. */
import { fixed } from "../units.js";
import { Sideways } from "../sideways.js";
import { html, useState } from "../view.js";
import { axisTitle, metricTitle, valueText } from "./words.js";

const SHOWN = 200;

export function Sets({ study, metric, layout }) {
  const [order, sortBy] = useState({ by: "set", up: true });
  const [all, showAll] = useState(false);
  const columns = columnsOf(layout.axes, metric);
  const by = columns.find(({ name }) => name === order.by) ?? columns[0];
  const sorted = [...study.sets].sort((a, b) => compared(by.value(a), by.value(b)) * (order.up ? 1 : -1));
  const shown = all ? sorted : sorted.slice(0, SHOWN);
  return html`
    <${Sideways} name="sets-scroll">
      <table class="sets-table">
        <caption class="unseen">Sets of this study</caption>
        <thead><tr>${columns.map((column) => html`<${Heading} column=${column} order=${order} sortBy=${sortBy} />`)}</tr></thead>
        <tbody>${shown.map((set) => html`<tr key=${set.set} data-best=${set.set === study.best?.set}>${columns.map(({ name, cell }) => html`<td data-column=${name}>${cell(set)}</td>`)}</tr>`)}</tbody>
      </table>
      ${shown.length < sorted.length && html`<p class="show-more"><button type="button" onClick=${() => showAll(true)}>Show all ${sorted.length.toLocaleString("en")}</button></p>`}
    <//>
  `;
}

function Heading({ column: { name, title }, order, sortBy }) {
  const own = order.by === name;
  return html`
    <th scope="col" aria-sort=${own ? (order.up ? "ascending" : "descending") : "none"}>
      <button class="quiet" type="button" onClick=${() => sortBy({ by: name, up: own ? !order.up : true })}>${title}${own ? (order.up ? " ▴" : " ▾") : ""}</button>
    </th>
  `;
}

function columnsOf(axes, metric) {
  const digits = metric[3];
  const number = (name, title, value, decimals) => ({ name, title, value, cell: (set) => fixed(value(set), decimals) });
  return [
    number("set", "Set", ({ set }) => set, 0),
    ...axes.map((axis) => ({ name: axis.name, title: axisTitle(axis), value: ({ values }) => values[axis.name], cell: ({ values }) => valueText(values[axis.name]) })),
    number("runs", "Runs", ({ runs }) => runs, 0),
    number("failed", "Failed", ({ failed }) => failed, 0),
    number("mean", metricTitle(metric), ({ mean }) => mean, digits),
    number("low", "95 % from", ({ low }) => low, digits),
    number("high", "to", ({ high }) => high, digits),
  ];
}

/** What is not known comes last when the smallest comes first. */
function compared(a, b) {
  if (typeof a === "string" && typeof b === "string") return a.localeCompare(b);
  return (a ?? Infinity) < (b ?? Infinity) ? -1 : Number((a ?? Infinity) > (b ?? Infinity));
}
