/** Three charts with one cursor: of the last minute of the rig, or of whatever else a source tells. */
import { html, useEffect, useRef, useState } from "../view.js";
import { quantity } from "../units.js";
import { createChart } from "./chart.js";
import { lastMinute } from "./last_minute.js";

const DIGITS = { mm: 1, deg: 0, A: 2 };
const COILS = [["x", "first"], ["y", "second"], ["z", "third"]];

/** curves: column, label, unit, colour token, style; only those with a label, be it empty, are in the legend. */
export const CHARTS = [
  {
    title: "Error", note: "distance from the centre to the target", empty: "Shown once a run is on.",
    curves: [{ column: "error_mm", label: "error", unit: "mm", colour: "first", fromZero: true }],
  },
  {
    title: "Pose", note: "line estimate · dots measured · dashes reference",
    curves: [
      ...tripled("x", "x", "mm", "first"),
      ...tripled("y", "y", "mm", "second"),
      { column: "heading_deg", label: "heading", unit: "deg", colour: "third" },
      { column: "heading_measured_deg", unit: "deg", colour: "third", style: "dots" },
      { column: "heading_goal_deg", unit: "deg", colour: "third", style: "dashes" },
    ],
  },
  {
    title: "Currents", note: "line commanded · dots measured",
    curves: COILS.flatMap(([axis, colour]) => [
      { column: `current_${axis}_A`, label: axis, unit: "A", colour },
      { column: `measured_${axis}_A`, unit: "A", colour, style: "dots" },
    ]),
  },
];

function tripled(name, label, unit, colour) {
  return [
    { column: `${name}_mm`, label, unit, colour },
    { column: `${name}_measured_mm`, unit, colour, style: "dots" },
    { column: `${name}_reference_mm`, unit, colour, style: "dashes" },
  ];
}

export function Charts() {
  return html`<section class="charts" aria-label="Charts of the last minute">
    ${CHARTS.map((chart) => html`<${Chart} key=${chart.title} ...${chart} source=${lastMinute} span="over the last 60 seconds" />`)}
  </section>`;
}

/** span: "over the last 60 seconds", in the chart's name for a screen reader. */
export function Chart({ title, note, curves, empty, source, span }) {
  const box = useRef(null);
  const [{ values, blank }, show] = useState({ values: [], blank: true });
  useEffect(() => createChart(box.current, curves, source, (newest, nothing) => show({ values: newest, blank: nothing })), [curves, source]);
  return html`
    <section class="card chart" aria-label=${title}>
      <header class="card-head">
        <h2>${title}</h2>
        ${curves.map(({ label, unit, colour, style }, index) => label !== undefined && html`
          <span class="legend" data-colour=${colour} data-style=${style ?? "line"}>${label}<b>${quantity(values[index], unit, DIGITS[unit])}</b></span>
        `)}
        ${note && html`<span class="hint">${note}</span>`}
      </header>
      <div class="plot" ref=${box} role="img" aria-label=${`${title} ${span}`}></div>
      ${empty && blank && html`<p class="plot-note">${empty}</p>`}
    </section>
  `;
}
