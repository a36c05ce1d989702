/** What the charts show while the rig itself is looked at: the last minute, up to now. */
import { live, onTick, WINDOW_S } from "../live/ticks.js";

/** A chart is drawn at most this often: faster cannot be followed, ms. */
const REDRAW_MS = 100;
/** Numbers that change faster cannot be read, ms. */
const LEGEND_MS = 200;
const AGO_S = [60, 45, 30, 15, 0];

/** Hears of a tick, but not of the next ones for a while; of none while nobody looks. */
function onTickAtMost(period_ms, listener) {
  let told = 0;
  return onTick(() => {
    const now = performance.now();
    if (now - told < period_ms || document.hidden) return;
    told = now;
    listener();
  });
}

/** @implements the source of `createChart` */
export const lastMinute = {
  columns: (curves) => [live.history.time_s, ...curves.map(({ column }) => live.history[column])],
  range: (_, __, newest) => [newest - WINDOW_S, newest],
  valuesAt: ([times, ...columns], cursor) => columns.map((values) => values[cursor ?? times.length - 1]),
  onChange: (listener) => onTickAtMost(REDRAW_MS, listener),
  onTime: (listener) => onTickAtMost(LEGEND_MS, listener),
  timeAxis: {
    splits: (plot) => AGO_S.map((seconds) => plot.scales.x.max - seconds),
    values: () => AGO_S.map((seconds) => (seconds === 0 ? "now" : `−${seconds} s`)),
  },
};
