/** Sets that lie anywhere between two axes (a Latin hypercube, a search for the best): a dot each, coloured. */
import { html } from "../view.js";
import { linear, padded, ticksOf, useWidth } from "./chart.js";
import { isNumeric } from "./projection.js";
import { colourAt } from "./scale.js";
import { axisTitle, metricTitle, setText, valueText, withInterval } from "./words.js";

const HEIGHT = 300;
const MARGIN = { left: 56, right: 16, top: 12, bottom: 42 };
const RADIUS = 7;

/** surface: what a search has learned of these two axes, or null. */
export function Scatter({ sets, layout, scale, metric, caption, best, surface }) {
  const [place, width] = useWidth();
  const { across, down } = layout;
  const x = alongAxis(across, [MARGIN.left, width - MARGIN.right], surface?.marks[0]);
  const y = down ? alongAxis(down, [HEIGHT - MARGIN.bottom, MARGIN.top], surface?.marks[1]) : Object.assign(() => HEIGHT / 2, { ticks: [] });
  return html`
    <figure class="scatter" ref=${place}>
      ${caption && html`<figcaption>${caption}</figcaption>`}
      <svg width=${width} height=${HEIGHT} role="img" aria-label=${`${metricTitle(metric)} of each set, by ${across.title.toLowerCase()}${down ? ` and ${down.title.toLowerCase()}` : ""}; the table of sets has the numbers`}>
        ${surface && scale && html`<${Surface} surface=${surface} x=${x} y=${y} scale=${scale} />`}
        <${Axes} x=${x} y=${y} width=${width} across=${across} down=${down} />
        ${sets.map((set) => html`<${Dot} key=${set.set} set=${set} x=${x(set.values[across.name])} y=${y(down && set.values[down.name])} scale=${scale} metric=${metric} axes=${layout.axes} best=${set.set === best} />`)}
      </svg>
    </figure>
  `;
}

/**
 * @param {import("../types").Axis} axis
 * @param {number[]} ends px
 * @param {number[]} [marks] what else has to have its place along it
 * @returns {((value: any) => number) & {ticks: any[]}}
 */
function alongAxis(axis, ends, marks = []) {
  const { values } = axis;
  if (!isNumeric(axis)) {
    const even = linear([-0.5, values.length - 0.5], ends);
    return Object.assign((value) => even(values.indexOf(value)), { ticks: values });
  }
  const all = [...values, ...marks];
  const [low, high] = [Math.min(...all), Math.max(...all)];
  return Object.assign(linear(padded(low, high), ends), { ticks: ticksOf(low, high, 5) });
}

function Axes({ x, y, width, across, down }) {
  const foot = HEIGHT - MARGIN.bottom;
  const middle = (MARGIN.left + width - MARGIN.right) / 2;
  return html`
    <g class="frame">
      ${x.ticks.map((value) => html`<path d=${`M${x(value)} ${foot}v4`} /><text x=${x(value)} y=${foot + 16} text-anchor="middle">${valueText(value)}</text>`)}
      ${y.ticks.map((value) => html`<path d=${`M${MARGIN.left} ${y(value)}h-4`} /><text x=${MARGIN.left - 7} y=${y(value)} text-anchor="end" dominant-baseline="central">${valueText(value)}</text>`)}
      <path d=${`M${MARGIN.left} ${MARGIN.top}V${foot}H${width - MARGIN.right}`} />
      <text x=${middle} y=${HEIGHT - 6} text-anchor="middle">${axisTitle(across)}</text>
      ${down && html`<text transform=${`translate(12 ${(MARGIN.top + foot) / 2}) rotate(-90)`} text-anchor="middle">${axisTitle(down)}</text>`}
    </g>
  `;
}

function Dot({ set, x, y, scale, metric, axes, best }) {
  const known = Number.isFinite(set.mean) && scale !== null;
  const words = known ? withInterval(set, metric[3]) : "not known yet";
  return html`
    <circle class="dot" data-state=${known ? "known" : "waiting"} data-best=${best} cx=${x} cy=${y} r=${best ? RADIUS + 2 : RADIUS} fill=${known ? colourAt(scale.share(set.mean)) : "none"}>
      <title>${setText(set.values, axes)}: ${words}, n = ${set.runs}</title>
    </circle>
  `;
}

/** A rectangle for each place of the learned grid. */
function Surface({ surface, x, y, scale }) {
  const [columns, rows] = surface.marks;
  return html`
    <g class="surface" aria-hidden="true">
      ${rows.flatMap((row, index) => columns.map((column, place) => {
        const [left, right] = edges(columns, place).map(x);
        const [foot, top] = edges(rows, index).map(y);
        return html`<rect x=${left} y=${top} width=${right - left + 0.5} height=${foot - top + 0.5} fill=${colourAt(scale.share(surface.mean[index][place]))} />`;
      }))}
    </g>
  `;
}

/** Half way to the neighbours. */
const edges = (grid, index) => [
  index > 0 ? (grid[index - 1] + grid[index]) / 2 : grid[0],
  index < grid.length - 1 ? (grid[index] + grid[index + 1]) / 2 : grid.at(-1),
];
