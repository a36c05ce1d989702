/** One axis against the figure, a line for each value of another one, with its 95 % intervals. */
import { fixed } from "../units.js";
import { html } from "../view.js";
import { linear, padded, ticksOf, useWidth } from "./chart.js";
import { Mark } from "./marks.js";
import { isNumeric, setAt } from "./projection.js";
import { axisTitle, metricTitle, setText, valueText, valueWithUnit, withInterval } from "./words.js";

const HEIGHT = 260;
const MARGIN = { left: 52, right: 14, top: 10, bottom: 40 };
const CAP = 4;
const APART = 5;
const ALL_APART = 24;

/** range: [low, high] of the figure, the same in every panel. */
export function Lines({ sets, layout, range, metric, caption }) {
  const [place, width] = useWidth();
  const { across, down } = layout;
  const x = placesAcross(across, width);
  const y = linear(range, [HEIGHT - MARGIN.bottom, MARGIN.top]);
  const rows = down?.values ?? [null];
  return html`
    <figure class="lines" ref=${place}>
      ${caption && html`<figcaption>${caption}</figcaption>`}
      <svg width=${width} height=${HEIGHT} role="img" aria-label=${`${metricTitle(metric)} over ${across.title.toLowerCase()}${caption ? `, ${caption}` : ""}; the table of sets has the numbers`}>
        <${Frame} x=${x} y=${y} width=${width} range=${range} across=${across} metric=${metric} />
        ${rows.map((row, index) => html`<${Line} points=${pointsOf(sets, across, down, row)} x=${beside(x, index, rows.length)} y=${y} index=${index} axes=${layout.axes} metric=${metric} />`)}
      </svg>
    </figure>
  `;
}

/** Which line is which. */
export function LineLegend({ down }) {
  if (!down) return null;
  return html`
    <ul class="line-legend" aria-label=${down.title}>
      <li>${down.title}:</li>
      ${down.values.map((value, index) => html`<li><svg width="26" height="14" aria-hidden="true"><path class="line" data-line=${index % 7} d="M0 7H26" /><${Mark} index=${index} x=${13} y=${7} /></svg>${valueWithUnit(value, down)}</li>`)}
    </ul>
  `;
}

/** Numbers at their place, names evenly. */
function placesAcross(across, width) {
  const ends = [MARGIN.left, width - MARGIN.right];
  const { values } = across;
  if (isNumeric(across)) return Object.assign(linear(padded(values[0], values.at(-1)), ends), { ticks: values.length <= 10 ? values : ticksOf(values[0], values.at(-1), 6) });
  const even = linear([-0.5, values.length - 0.5], ends);
  return Object.assign((value) => even(values.indexOf(value)), { ticks: values });
}

const pointsOf = (sets, across, down, row) =>
  across.values.map((value) => setAt(sets, across, value, down, row)).filter((set) => set && Number.isFinite(set.mean)).map((set) => ({ ...set, at: set.values[across.name] }));

function Frame({ x, y, width, range, across, metric }) {
  const right = width - MARGIN.right;
  const foot = HEIGHT - MARGIN.bottom;
  return html`
    <g class="frame">
      ${ticksOf(...range).map((value) => html`<path class="grid" d=${`M${MARGIN.left} ${y(value)}H${right}`} /><text x=${MARGIN.left - 6} y=${y(value)} text-anchor="end" dominant-baseline="central">${fixed(value, Math.max(metric[3] - 1, 0))}</text>`)}
      ${thinned(x.ticks, width).map((value) => html`<path d=${`M${x(value)} ${foot}v4`} /><text x=${x(value)} y=${foot + 16} text-anchor="middle">${valueText(value)}</text>`)}
      <path d=${`M${MARGIN.left} ${MARGIN.top}V${foot}H${right}`} />
      <text x=${(MARGIN.left + right) / 2} y=${HEIGHT - 6} text-anchor="middle">${axisTitle(across)}</text>
    </g>
  `;
}

/** Lines over the same places stand a little apart, so that their intervals can be told from each other. */
const beside = (x, index, count) => (value) => x(value) + (index - (count - 1) / 2) * Math.min(APART, ALL_APART / count);

/** As many as there is room for. */
function thinned(values, width) {
  const every = Math.ceil(values.length / Math.max(2, Math.floor(width / 55)));
  return values.filter((_, index) => index % every === 0);
}

function Line({ points, x, y, index, axes, metric }) {
  if (points.length === 0) return null;
  const path = points.map((point, order) => `${order ? "L" : "M"}${x(point.at).toFixed(1)} ${y(point.mean).toFixed(1)}`).join("");
  const known = points.filter(({ low, high }) => Number.isFinite(low) && Number.isFinite(high));
  const bars = known.map(({ at, low, high }) => `M${x(at) - CAP} ${y(low)}h${2 * CAP}m${-CAP} 0V${y(high)}m${-CAP} 0h${2 * CAP}`).join("");
  return html`
    <g data-line=${index % 7}>
      <path class="line" data-line=${index % 7} d=${path} />
      <path class="interval" data-line=${index % 7} d=${bars} />
      ${points.map((point) => html`<${Mark} index=${index} x=${x(point.at)} y=${y(point.mean)} title=${`${setText(point.values, axes)}: ${withInterval(point, metric[3])}, n = ${point.runs}`} />`)}
    </g>
  `;
}
