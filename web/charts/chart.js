/** One uPlot chart over time; colours follow the page's tokens, light or dark. */
import uPlot from "/static/vendor/uplot/uPlot.esm.js";
import { fixed } from "../units.js";

const SYNC = uPlot.sync("dashboard");
/** The least that an axis spans, so that noise at rest does not fill the chart. */
const LEAST_SPAN = { mm: 4, deg: 20, A: 2 };
const PAD = 0.08;

/**
 * @param {HTMLElement} box
 * @param curves [{column, unit, colour, style, fromZero}]
 * @param source whose values (the rig's: charts/last_minute.js): columns(curves) -> [times, values…]; range of the
 *        time axis, as uPlot asks for it; valuesAt(columns, cursor's index or null) for the legend; onChange(listener)
 *        of the values and onTime(listener) of the time -> forget; timeAxis {splits?, values};
 *        attach?(plot) -> detach, for what it draws and hears itself
 * @param {(values: Array, blank: boolean) => void} onValues one a curve, under the cursor or at the source's time;
 *        blank: there is nothing to draw at all
 * @returns {() => void} takes the chart away
 */
export function createChart(box, curves, source, onValues) {
  let [plot, detach] = build(box, curves, source);
  const tell = () => onValues(source.valuesAt(plot.data, plot.cursor.idx ?? null), isBlank(plot.data.slice(1)));
  const forget = [source.onChange(() => plot.setData(source.columns(curves))), source.onTime(tell)];
  tell();
  const resized = new ResizeObserver(() => plot.setSize(sizeOf(box)));
  resized.observe(box);
  const theme = matchMedia("(prefers-color-scheme: dark)");
  const away = () => {
    detach();
    plot.destroy();
  };
  const repaint = () => {
    away();
    [plot, detach] = build(box, curves, source);
  };
  theme.addEventListener("change", repaint);
  return () => {
    for (const stop of forget) stop();
    resized.disconnect();
    theme.removeEventListener("change", repaint);
    away();
  };
}

const isBlank = (columns) => columns.every((column) => column.every((value) => value === null || value === undefined));

const sizeOf = (box) => ({ width: Math.max(120, box.clientWidth), height: Math.max(80, box.clientHeight) });

function build(box, curves, source) {
  const style = getComputedStyle(document.documentElement);
  const token = (name) => style.getPropertyValue(name).trim();
  const units = [...new Set(curves.map(({ unit }) => unit))];
  const options = {
    ...sizeOf(box),
    legend: { show: false },
    padding: [8, units.length > 1 ? 0 : 20, 0, 0],
    cursor: { sync: { key: SYNC.key, setSeries: false }, drag: { x: false, y: false }, points: { size: 5 }, y: false },
    scales: { x: { time: false, range: source.range }, ...scalesOf(units, curves.every((curve) => curve.fromZero)) },
    axes: [{ ...look(token), size: 26, ...source.timeAxis }, ...units.map((unit, index) => axis(unit, index, token))],
    series: [{}, ...curves.map((curve) => series(curve, token))],
  };
  const plot = new uPlot(options, source.columns(curves), box);
  return [plot, source.attach?.(plot) ?? (() => {})];
}

const scalesOf = (units, fromZero) =>
  Object.fromEntries(units.map((unit) => [unit, { range: (_, low, high) => roomy(low, high, LEAST_SPAN[unit], fromZero) }]));

/** The range of the data with a little air, and never less than `least`; a distance starts at zero. */
function roomy(low, high, least, fromZero) {
  if (low === null || high === null) return [0, least];
  if (fromZero) return [0, Math.max(least, high * (1 + PAD))];
  const span = Math.max(least, high - low) * (1 + 2 * PAD);
  const middle = (low + high) / 2;
  return [middle - span / 2, middle + span / 2];
}

function series({ unit, colour, style }, token) {
  const stroke = token(`--curve-${colour}`);
  const common = { scale: unit, stroke, width: 1.5, points: { show: false }, spanGaps: false };
  if (style === "dots") return { ...common, paths: () => null, points: { show: true, size: 2.5, fill: stroke, width: 0, filter: everyOther } };
  if (style === "dashes") return { ...common, width: 1.25, dash: [5, 4], alpha: 0.85 };
  return common;
}

/** Dots at a few hertz: one a tick would hide the line under them. */
function everyOther(plot, seriesIndex, show) {
  if (!show) return null;
  const step = Math.max(1, Math.ceil((plot.data[0].length * 4) / plot.bbox.width));
  return plot.data[seriesIndex].map((_, index) => index).filter((index) => index % step === 0);
}

function axis(unit, index, token) {
  return {
    ...look(token),
    scale: unit,
    side: index === 0 ? 3 : 1,
    size: 52,
    space: 28,
    grid: { show: index === 0, stroke: token("--line"), width: 1 },
    values: (_, splits) => splits.map((value) => tickText(value, unit, splits)),
  };
}

function tickText(value, unit, splits) {
  const digits = splits.length > 1 && splits[1] - splits[0] < 1 ? 1 : 0;
  return unit === "deg" ? `${fixed(value, digits)}°` : `${fixed(value, digits)} ${unit}`;
}

const look = (token) => ({
  stroke: token("--ink-soft"),
  font: "11px system-ui, sans-serif",
  grid: { stroke: token("--line"), width: 1 },
  ticks: { show: false },
});
