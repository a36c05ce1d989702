/** Charts with one cursor: of the last hour of the rig, or of whatever else a source tells. */
import { useStore } from "../store.js";
import { quantity, wrapDegrees } from "../units.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { createChart } from "./chart.js";
import { CHARTS } from "./curves.js";
import { rigSource } from "./rig_source.js";
import { spanWords } from "./span.js";
import { Toolbar } from "./toolbar.js";
import { toggleCurve, useView } from "./view.js";

const DIGITS = { mm: 1, deg: 0, A: 2, ms: 0 };

export function Charts() {
  const view = useView();
  const shown = CHARTS.filter(({ title }) => !view.folded.includes(title));
  return html`
    <section class="charts" aria-label="Charts of the last hour" data-charts=${shown.length}>
      <${Toolbar} />
      ${shown.map((chart) => html`<${Chart} key=${chart.title} ...${chart} source=${rigSource} span=${spanWords(view)} />`)}
    </section>
  `;
}

/** span: "over the last 60 seconds", in the chart's name for a screen reader. */
export function Chart({ title, note, curves, empty, source, span }) {
  const box = useRef(null);
  const chart = useRef(null);
  const hidden = useStore((state) => state.charts.hidden);
  const [{ values, blank }, show] = useState({ values: /** @type {(number | null)[]} */ ([]), blank: true });
  useEffect(() => {
    chart.current = createChart(box.current, curves, source, (newest, nothing) => show({ values: newest, blank: nothing }));
    return () => chart.current.close();
  }, [curves, source]);
  useEffect(() => chart.current.hide(hidden), [hidden, curves, source]);
  return html`
    <section class="card chart" aria-label=${title}>
      <header class="card-head">
        <h2>${title}</h2>
        ${curves.map((curve, index) => curve.label !== undefined && html`
          <${Legend} ...${curve} value=${values[index]} isHidden=${hidden.includes(curve.group)} />
        `)}
        ${note && html`<span class="hint" title=${note}>${note}</span>`}
      </header>
      <div class="plot" ref=${box} role="img" tabindex="0" aria-label=${`${title} ${span}`}></div>
      ${empty && blank && html`<p class="plot-note">${empty}</p>`}
    </section>
  `;
}

/** A curve of an angle goes on over the turn; in words it is that of the readings. */
const onOneTurn = (value, unit) => (unit === "deg" && typeof value === "number" ? wrapDegrees(value) : value);

/** A curve without words of its own stands beside the one it belongs to. */
function Legend({ label, group, unit, colour, style, value, isHidden }) {
  return html`
    <span class="legend" data-colour=${colour} data-style=${style ?? "line"} data-hidden=${isHidden}>
      ${label && html`<button class="curve" type="button" aria-pressed=${!isHidden} title=${isHidden ? "Show this curve" : "Hide this curve"} onClick=${() => toggleCurve(group)}>${label}</button>`}
      <b>${quantity(onOneTurn(value, unit), unit, DIGITS[unit])}</b>
    </span>
  `;
}
