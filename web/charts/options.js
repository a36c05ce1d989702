/** How a chart looks: axes, curves and their colours, in the words of uPlot. */
import uPlot from "../vendor/uplot/uPlot.mjs";
import { fixed } from "../units.js";
import { extent, roomy, traceDots, traceLine } from "./pixels.js";

const SYNC = uPlot.sync("dashboard");
/** The least that an axis spans, so that noise at rest does not fill the chart. */
const LEAST_SPAN = { mm: 4, deg: 20, A: 2, ms: 20 };
/** Between two dots, CSS px: one a tick would hide the line under them. */
const DOTS_PX = 5;

/** @returns {any} all but the size */
export function optionsOf(curves, source) {
  const style = getComputedStyle(document.documentElement);
  const token = (name) => style.getPropertyValue(name).trim();
  const units = [...new Set(curves.map(({ unit }) => unit))];
  return {
    legend: { show: false },
    padding: [8, units.length > 1 ? 0 : 14, 0, 0],
    cursor: { sync: { key: SYNC.key, setSeries: false }, drag: { x: false, y: false }, points: { size: 5 }, y: false, dataIdx: knownAt },
    scales: { x: { time: false, range: source.range }, ...scalesOf(units, curves) },
    axes: [{ ...look(token), size: 26, ...source.timeAxis }, ...units.map((unit, index) => axis(unit, index, token))],
    series: [{}, ...curves.map((curve) => series(curve, token))],
  };
}

/** No point of the cursor where a curve has no value. */
const knownAt = (plot, index, at) => (Number.isNaN(plot.data[index][at]) ? null : at);

const scalesOf = (units, curves) => Object.fromEntries(units.map((unit) => [unit, { range: rangeOf(unit, curves) }]));

/** uPlot's own search for the lowest and the highest does not know NaN. */
function rangeOf(unit, curves) {
  const fromZero = curves.filter((curve) => curve.unit === unit).every((curve) => curve.fromZero);
  return (plot, low, high) => {
    const found = Number.isFinite(low) && Number.isFinite(high) ? [low, high] : extent(shownColumns(plot, unit));
    return roomy(found, LEAST_SPAN[unit], fromZero);
  };
}

const shownColumns = (plot, unit) => plot.data.filter((_, index) => index > 0 && plot.series[index].show && plot.series[index].scale === unit);

function series({ unit, colour, style }, token) {
  const common = { scale: unit, stroke: token(`--curve-${colour}`), width: 1.5, points: { show: false }, paths: linePaths };
  if (style === "dots") return { ...common, paths: dotPaths, width: 2.5, cap: "round" };
  if (style === "dashes") return { ...common, width: 1.25, dash: [5, 4], alpha: 0.85 };
  return common;
}

/** uPlot lets a path be drawn over a gap only where the values are null; ours are NaN, in typed arrays. */
function pathsBy(trace) {
  return (plot, index, first, last) => {
    const stroke = new Path2D();
    const { scale } = plot.series[index];
    const toX = linear(plot, "x");
    const toY = linear(plot, scale);
    trace(cut(plot.data[0], first, last), cut(plot.data[index], first, last), toX, toY, stroke, plot);
    return { stroke, fill: null, clip: null, band: null, gaps: null, flags: 1 };
  };
}

const linePaths = pathsBy(traceLine);
const dotPaths = pathsBy((times, values, toX, toY, pen, plot) => {
  const cell_s = (DOTS_PX * (plot.scales.x.max - plot.scales.x.min)) / (plot.over.clientWidth || 1);
  traceDots(times, values, toX, toY, pen, cell_s);
});

const cut = (values, first, last) => (ArrayBuffer.isView(values) ? /** @type {any} */ (values).subarray(first, last + 1) : values.slice(first, last + 1));

/** From a value to a pixel of the canvas; both axes are straight. */
function linear(plot, scale) {
  const [zero, one] = [plot.valToPos(0, scale, true), plot.valToPos(1, scale, true)];
  return (value) => zero + (one - zero) * value;
}

function axis(unit, index, token) {
  return {
    ...look(token),
    scale: unit,
    side: index === 0 ? 3 : 1,
    size: 54,
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
