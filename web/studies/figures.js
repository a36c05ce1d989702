/** The study in pictures: which axis goes where, a panel for each value of a third one, as a map or as lines. */
import { html, useState } from "../view.js";
import { padded } from "./chart.js";
import { HeatMap } from "./heat_map.js";
import { Legend } from "./legend.js";
import { LineLegend, Lines } from "./lines.js";
import { showMetric } from "./listing.js";
import { isGrid, layoutOf, panelsOf } from "./projection.js";
import { scaleOf } from "./scale.js";
import { Scatter } from "./scatter.js";
import { Sets } from "./sets.js";
import { axisTitle, METRICS, metricOf, metricTitle, valueText, valueWithUnit } from "./words.js";

const KINDS = [["map", "Map"], ["lines", "Lines"], ["table", "Table"]];

export function Figures({ study }) {
  /** @type {[any, (view: any) => void]} kind: "map", "lines", "table", or null while nobody has chosen */
  const [view, setView] = useState({ kind: null, across: null, down: null, fixed: {} });
  const turn = (part) => setView({ ...view, ...part });
  const layout = layoutOf(study, view);
  const metric = metricOf(study.metric);
  if (study.done === study.failed || study.sets.length === 0 || !layout.across) return html`<p class="hint">The figures fill as runs finish.</p>`;
  const kind = view.kind ?? (layout.down ? "map" : "lines");
  return html`
    <section class="study-figures" aria-label="Figures">
      <${Choices} kind=${kind} view=${view} turn=${turn} layout=${layout} metric=${metric} />
      ${kind === "table" ? html`<${Sets} study=${study} metric=${metric} layout=${layout} />` : html`<${Panels} kind=${kind} study=${study} layout=${layout} metric=${metric} />`}
    </section>
  `;
}

function Panels({ kind, study, layout, metric }) {
  const panels = panelsOf(study.sets, layout);
  const shown = panels.flatMap(({ sets }) => sets);
  const surface = surfaceOf(study, layout);
  const scale = scaleOf([...shown.map(({ mean }) => mean), ...(surface?.mean.flat() ?? [])]);
  const grid = study.design !== "tune" && study.design !== "latin" && isGrid(study.sets, layout);
  const Picture = kind === "lines" && grid ? Lines : grid ? HeatMap : Scatter;
  const bounds = scaleOf(shown.flatMap(({ mean, low, high }) => [mean, low, high]));
  const range = bounds ? padded(bounds.low, bounds.high) : [0, 1];
  return html`
    ${Picture === Lines && html`<p class="hint">${metricTitle(metric)}</p>`}
    ${Picture === Lines ? html`<${LineLegend} down=${layout.down} />` : html`<${Legend} scale=${scale} metric=${metric} />`}
    <div class="panels" data-picture=${Picture === HeatMap ? "map" : "drawn"} data-count=${panels.length}>
      ${panels.map(({ value, sets }) => html`
        <${Picture} key=${valueText(value)} sets=${sets} layout=${layout} scale=${scale} range=${range} metric=${metric} best=${study.best?.set ?? null}
          surface=${surface} caption=${layout.panel ? `${layout.panel.title} ${valueWithUnit(value, layout.panel)}` : ""} />
      `)}
    </div>
    ${study.best && Picture === HeatMap && html`<p class="hint">The framed cell has the smallest mean.</p>`}
    ${surface && html`<p class="hint">Behind the dots: what the search expects, all other axes at their best.</p>`}
    ${kind === "lines" && grid && html`<p class="hint">Bars: 95 % interval of the mean.</p>`}
    ${kind === "lines" && !grid && html`<p class="hint">These sets do not lie on a grid, so there are no lines to draw: a dot each.</p>`}
  `;
}

/** Only where it is of these two axes, in this order, and of what is shown. */
function surfaceOf({ surface, metric }, { across, down }) {
  const ours = surface?.metric === metric && surface.axes.length === 2 && surface.axes[0] === across.name && surface.axes[1] === down?.name;
  return ours && surface.marks.flat().every(Number.isFinite) ? surface : null;
}

function Choices({ kind, view, turn, layout, metric }) {
  const { axes, across, down, chosen } = layout;
  const fix = (axis) => (event) => turn({ fixed: { ...view.fixed, [axis.name]: axis.values[event.target.selectedIndex] } });
  return html`
    <div class="figure-choices">
      <div class="segments" role="radiogroup" aria-label="Show as">
        ${KINDS.map(([name, words]) => html`<label><input type="radio" name="study-figure" checked=${kind === name} onChange=${() => turn({ kind: name })} /><span>${words}</span></label>`)}
      </div>
      <${Pick} title="Figure" options=${METRICS.map(([, words]) => words)} index=${METRICS.indexOf(metric)} pick=${(index) => showMetric(METRICS[index][0])} />
      ${kind !== "table" && axes.length > 1 && html`
        <${Pick} title="Across" options=${axes.map(axisTitle)} index=${axes.indexOf(across)} pick=${(index) => turn({ across: axes[index].name, down: axes[index] === down ? across.name : view.down })} />
        <${Pick} title=${kind === "lines" ? "A line each" : "Down"} options=${axes.map(axisTitle)} index=${axes.indexOf(down)} pick=${(index) => turn({ down: axes[index].name, across: axes[index] === across ? down.name : view.across })} />
        ${chosen.map(({ axis, value }) => html`
          <label class="pick"><span>${axis.title}</span><select onChange=${fix(axis)}>${axis.values.map((each) => html`<option selected=${each === value}>${valueWithUnit(each, axis)}</option>`)}</select></label>
        `)}`}
    </div>
  `;
}

const Pick = ({ title, options, index, pick }) => html`
  <label class="pick"><span>${title}</span>
    <select onChange=${(event) => pick(event.target.selectedIndex)}>${options.map((words, place) => html`<option selected=${place === index}>${words}</option>`)}</select>
  </label>
`;
