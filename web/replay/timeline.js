/** What the charts draw of recorded runs: each on the time since its own start, with the time of the replay. */
import uPlot from "/static/vendor/uplot/uPlot.esm.js";
import { get } from "../store.js";
import { now_s, onTextTime, onTime, seek, zoomOut, zoomTo } from "./player.js";
import { indexAt } from "./recording.js";
import { stamp } from "./signs.js";
import { clock } from "../units.js";

/** A drag shorter than this is a click, CSS px. */
const CLICK_PX = 4;
/** Values of a run may stand that many places before the cursor's: another run's times lie between, */
const REACH = 8;

/**
 * @param runs recordings (recording.js), one or two
 * @implements the source of `createChart`; changed() when there is something else to draw
 */
export function wholeRun(runs) {
  const listeners = new Set();
  return {
    columns: (curves) => columnsOf(runs, curves),
    range: () => shownRange(),
    valuesAt: ([times, ...columns], cursor) => columns.map((values) => lastBefore(values, cursor ?? indexAt(times, now_s()))),
    onChange(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    changed: () => listeners.forEach((listener) => listener()),
    onTime: onTextTime,
    timeAxis: { values: (_, splits) => splits.map(splits.every(Number.isInteger) ? clock : stamp) },
    attach,
  };
}

/** [times, values…], one a curve, in the order of the curves. */
function columnsOf(runs, curves) {
  if (runs.length === 1) return [runs[0].series.time_s, ...curves.map(({ column }) => runs[0].series[column])];
  const tables = runs.map(({ series }, index) => [series.time_s, ...curves.filter(({ run = 0 }) => run === index).map(({ column }) => series[column])]);
  const [times, ...joined] = uPlot.join(tables);
  const firsts = runs.map((_, index) => tables.slice(0, index).reduce((count, table) => count + table.length - 1, 0));
  return [times, ...curves.map(({ run = 0 }) => joined[firsts[run]++])];
}

function shownRange() {
  const { zoom, duration_s } = get().replay ?? {};
  return zoom ?? [0, duration_s || 1];
}

/** undefined: a time of the other run, at which this one has no value of its own. */
function lastBefore(values, index) {
  for (let at = index; at >= Math.max(0, index - REACH); at -= 1) if (values[at] !== undefined) return values[at];
  return null;
}

/** The line at the time of the replay; a click goes to a time, a drag looks closer, a double click sees all again. */
function attach(plot) {
  const line = plot.over.appendChild(document.createElement("div"));
  line.className = "chart-time";
  const place = () => {
    const [from, to] = shownRange();
    const time = now_s();
    line.hidden = !(from <= time && time <= to);
    line.style.transform = `translateX(${plot.valToPos(time, "x")}px)`;
  };
  plot.cursor.drag.x = true;
  plot.cursor.drag.setScale = false;
  plot.hooks.setSelect = [zoomToSelected];
  plot.hooks.setScale = [place];
  plot.hooks.setSize = [place];
  const clicks = hearClicks(plot);
  const forget = onTime(place);
  place();
  return () => {
    forget();
    clicks();
  };
}

function zoomToSelected(plot) {
  const { left, width } = plot.select;
  if (width < CLICK_PX) return;
  plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  zoomTo(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
}

/** The chart that is pressed in; those that only follow its cursor stay as they are. */
function hearClicks(plot) {
  let pressed = null;
  const press = (event) => void (pressed = event.clientX);
  const click = (event) => {
    if (pressed === null || Math.abs(event.clientX - pressed) >= CLICK_PX) return;
    seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
  };
  plot.over.addEventListener("pointerdown", press);
  plot.over.addEventListener("click", click);
  plot.over.addEventListener("dblclick", zoomOut);
  return () => {
    plot.over.removeEventListener("pointerdown", press);
    plot.over.removeEventListener("click", click);
    plot.over.removeEventListener("dblclick", zoomOut);
  };
}
