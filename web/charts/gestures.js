/** Looking closer: a drag, the wheel with Ctrl, two fingers, or the keys of a focused chart. A plain wheel scrolls the page. */
import { live } from "../live/ticks.js";
import { shiftedBy, standsStill, zoomedBy, zoomedTo } from "./span.js";
import { changeView, leaveZoom, span, view } from "./view.js";

/** A drag shorter than this is a click, CSS px. */
const CLICK_PX = 4;
const WHEEL_GAIN = 0.002;
const KEY_FACTOR = 1.5;
/** Of the width, for one press of an arrow key. */
const KEY_STEP = 0.02;

const newest = () => live.history.newest_s || 0;

/** @param {any} plot uPlot @returns {() => void} */
export function hearGestures(plot) {
  /** @type {Map<number, number>} where each finger or the mouse is, px from the left, by pointer */
  const down = new Map();
  let from = NaN;
  let pinched = false;
  const leftOf = (event) => event.clientX - plot.over.getBoundingClientRect().left;
  const timeAt = (left) => plot.posToVal(left, "x");

  // uPlot draws what is being selected; what becomes of it is decided here.
  plot.cursor.drag.x = true;
  plot.cursor.drag.setScale = false;
  plot.hooks.setSelect = [(self) => self.select.width > 0 && self.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false)];

  const press = (event) => {
    if (event.button !== 0) return;
    down.set(event.pointerId, leftOf(event));
    from = leftOf(event);
    pinched = down.size > 1;
    if (event.pointerType === "touch") plot.over.setPointerCapture(event.pointerId);
  };
  const move = (event) => {
    if (event.pointerType !== "touch" || !down.has(event.pointerId)) return;
    const before = [...down.values()];
    down.set(event.pointerId, leftOf(event));
    if (down.size === 2) pinch(before, [...down.values()]);
    else plot.setCursor({ left: leftOf(event), top: plot.over.clientHeight / 2 });
  };
  const pinch = (before, after) => {
    const width = Math.abs(after[0] - after[1]);
    if (width < CLICK_PX) return;
    const factor = Math.abs(before[0] - before[1]) / width;
    changeView(zoomedBy(view(), newest(), factor, timeAt((after[0] + after[1]) / 2)));
  };
  const release = (event) => {
    if (!down.delete(event.pointerId) || pinched || event.pointerType === "touch") return;
    const [left, right] = [from, leftOf(event)].sort((one, other) => one - other);
    if (right - left >= CLICK_PX) changeView(zoomedTo(view(), [timeAt(left), Math.min(timeAt(right), newest())]));
  };
  const cancel = (event) => void down.delete(event.pointerId);
  const wheel = (event) => {
    const across = event.shiftKey ? event.deltaY : event.deltaX;
    if (event.ctrlKey) changeView(zoomedBy(view(), newest(), Math.exp(WHEEL_GAIN * event.deltaY), timeAt(leftOf(event))));
    else if (standsStill(view()) && across !== 0) shift(across / plot.over.clientWidth);
    else return;
    event.preventDefault();
  };
  const shift = (share) => {
    const [begin, end] = span();
    changeView(shiftedBy(view(), newest(), share * (end - begin)));
  };
  const key = (event) => {
    if (event.altKey || event.metaKey || event.ctrlKey) return;
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  };
  const middle = () => (plot.cursor.left >= 0 ? plot.cursor.left : plot.over.clientWidth / 2);
  const point = (step) => () => plot.setCursor({ left: clamped(middle() + step * plot.over.clientWidth), top: plot.over.clientHeight / 2 });
  const clamped = (left) => Math.min(Math.max(left, 0), plot.over.clientWidth);
  const closer = (factor) => () => changeView(zoomedBy(view(), newest(), factor, timeAt(middle())));
  const keys = {
    ArrowLeft: point(-KEY_STEP), ArrowRight: point(KEY_STEP),
    "+": closer(1 / KEY_FACTOR), "=": closer(1 / KEY_FACTOR), "-": closer(KEY_FACTOR), "0": leaveZoom,
  };

  const box = plot.root.parentElement;
  /** @type {[EventTarget, string, (event: any) => void][]} */
  const heard = [
    [plot.over, "pointerdown", press], [plot.over, "pointermove", move], [document, "pointerup", release],
    [document, "pointercancel", cancel], [plot.over, "dblclick", leaveZoom], [plot.over, "wheel", wheel], [box, "keydown", key],
  ];
  for (const [target, name, listener] of heard) target.addEventListener(name, listener, { passive: false });
  return () => heard.forEach(([target, name, listener]) => target.removeEventListener(name, listener));
}
