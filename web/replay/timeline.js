/** What the charts draw of recorded runs: each on the time since its own start, with the time of the replay. */
import uPlot from "../vendor/uplot/uPlot.mjs";
import { get } from "../store.js";
import { clock } from "../units.js";
import { now_s, onTextTime, onTime, seek, zoomOut, zoomTo } from "./player.js";
import { indexAt } from "./recording.js";
import { stamp } from "./signs.js";

/** A drag shorter than this is a click, CSS px. */
const CLICK_PX = 4;
/** Values of a run may stand that many places before the cursor's: another run's times lie between. */
const REACH = 8;

/**
 * @param runs recordings (recording.js), one or two
 * @implements the source of `createChart`; changed() when there is something else to draw
 */
export function wholeRun(runs) {
  const listeners = new Set();
  const pointed = new Set();
  return {
    columns: (curves) => columnsOf(runs, curves),
    range: () => shownRange(),
    valuesAt: ([times, ...columns], pointed) => columns.map((values) => lastBefore(values, indexAt(times, pointed ?? now_s()))),
    onChange(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    changed: () => listeners.forEach((listener) => listener()),
    onTime(listener) {
      pointed.add(listener);
      const forget = onTextTime(listener);
      return () => {
        pointed.delete(listener);
        forget();
      };
    },
    timeAxis: { values: (_, splits) => splits.map(wordsFor(splits)) },
    attach: (plot) => attach(plot, () => pointed.forEach((listener) => listener())),
  };
}

/** As many digits as tell the marks of an axis apart. */
function wordsFor(splits) {
  if (splits.every(Number.isInteger)) return clock;
  const digits = splits.every((time) => Math.abs(time * 10 - Math.round(time * 10)) < 1e-6) ? 1 : 2;
  return (time) => stamp(time, digits);
}

/** [times, values…], one a curve, in the order of the curves. */
function columnsOf(runs, curves) {
  const closer = get().replay?.closer ?? [];
  const shown = runs.map(({ series }, index) => closer[index] ?? series);
  if (shown.length === 1) return [shown[0].time_s, ...curves.map(({ column }) => shown[0][column])];
  const tables = shown.map((series, index) => [series.time_s, ...curves.filter(({ run = 0 }) => run === index).map(({ column }) => series[column])]);
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
function attach(plot, tellPointed) {
  const line = plot.over.appendChild(document.createElement("div"));
  line.className = "chart-time";
  const place = () => {
    const [from, to] = shownRange();
    const time = now_s();
    line.hidden = !(from <= time && time <= to);
    line.style.transform = `translateX(${plot.valToPos(time, "x")}px)`;
  };
  // uPlot draws what is being selected; what becomes of it is decided here.
  plot.cursor.drag.x = true;
  plot.cursor.drag.setScale = false;
  plot.hooks.setSelect = [forgetSelection];
  plot.hooks.setScale = [place];
  plot.hooks.setSize = [place];
  plot.hooks.setCursor = [tellPointed];
  const forgetPointer = hearPointer(plot);
  const forget = onTime(place);
  place();
  return () => {
    forget();
    forgetPointer();
  };
}

const forgetSelection = (plot) => plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);

/** Of the chart that is pressed in; those that only follow its cursor stay as they are. */
function hearPointer(plot) {
  let from = null;
  const timeAt = (x) => plot.posToVal(x - plot.over.getBoundingClientRect().left, "x");
  const press = (event) => void (from = event.button === 0 ? event.clientX : null);
  const release = (event) => {
    if (from === null) return;
    const [left, right] = [from, event.clientX].sort((one, other) => one - other);
    from = null;
    if (right - left < CLICK_PX) seek(timeAt(left));
    else if (event.pointerType !== "touch") zoomTo(timeAt(left), timeAt(right));
  };
  const cancel = () => void (from = null);
  const heard = [[plot.over, "pointerdown", press], [plot.over, "dblclick", zoomOut], [document, "pointerup", release], [document, "pointercancel", cancel]];
  for (const [target, name, listener] of heard) target.addEventListener(name, listener);
  return () => heard.forEach(([target, name, listener]) => target.removeEventListener(name, listener));
}
