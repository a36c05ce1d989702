/** What mouse, finger and keys do to the path in the picture: a line by hand, points to click, drag and remove. */
import { redraw, usePointer } from "../camera/pointing.js";
import { useEffect } from "../view.js";
import { change, drawing, edit, goOn, removePoint, restore, shape, useDrawing } from "./drawing.js";
import { isOnLine, onPlate, pointAt } from "./places.js";
import { added, inserted, MOST_POINTS, moved, placeOnLine } from "./shape.js";
import { distance, pathOf } from "./smoothing.js";

/** A finger that stays on a point for so long removes it, ms; it may tremble so far, CSS px. */
const LONG_PRESS_MS = 650;
const TREMBLE = 4;
/** The second click of a double click that has added a point does not remove it again, ms. */
const DOUBLE_MS = 600;
/** Points of a line by hand are at least so far apart, mm. */
const FINE_MM = 0.3;

/** What goes on under the finger, too fast for the store: the line so far, mm; the point that is held or hovered. */
export const pen = {
  /** @type {[number, number][] | null} */
  line: null,
  /** @type {{index: number, from: import("../camera/pointing.js").Place, before: any, recorded: boolean, timer: number} | null} */
  held: null,
  hovered: -1,
};
let newest = { index: -1, at: -Infinity };

/** @type {Record<string, (empty: boolean) => string>} */
const WORDS = {
  freehand: (empty) => (empty ? "Draw the path in one go" : "Drag a point, or draw a new path"),
  points: (empty) => (empty ? "Click the first point of the path" : "Click to add a point, drag one to move it"),
};

export function usePen() {
  const way = useDrawing((state) => state.way);
  const empty = useDrawing((state) => state.history.now.points.length === 0);
  usePointer({ words: WORDS[way](empty), press, move, release, cancel, hover, again, key });
  useEffect(() => letGo, []);
}

/** @returns whether something is held that follows the keys, too */
function press(place) {
  const at = onPlate(place);
  if (!at) return false;
  const hit = pointAt(place);
  if (hit >= 0) return hold(hit, place);
  if (drawing().way === "freehand") {
    pen.line = [at];
    return true;
  }
  if (shape().points.length >= MOST_POINTS) return false;
  const before = drawing().history;
  const index = isOnLine(place) ? placeOnLine(shape(), at) : shape().points.length;
  edit(index === shape().points.length ? added(shape(), at) : inserted(shape(), index, at), index);
  newest = { index, at: performance.now() };
  pen.held = { index, from: place, before, recorded: true, timer: 0 };
  return false;
}

function hold(index, place) {
  const remove = () => {
    letGo();
    removePoint(index);
  };
  const timer = place.touch ? setTimeout(remove, LONG_PRESS_MS) : 0;
  pen.held = { index, from: place, before: drawing().history, recorded: false, timer };
  change({ chosen: index });
  return true;
}

function move(place) {
  const at = onPlate(place);
  if (!at) return;
  if (pen.line) extend(at);
  else if (pen.held) drag(place, at);
}

function extend(at) {
  if (!pen.line || distance(pen.line[pen.line.length - 1], at) < FINE_MM) return;
  pen.line.push(at);
  redraw();
}

function drag(place, at) {
  const { held } = pen;
  if (!held) return;
  const far = Math.hypot(place.u - held.from.u, place.v - held.from.v);
  if (held.timer && far <= TREMBLE * place.pixel) return;
  clearTimeout(held.timer);
  held.timer = 0;
  const next = moved(shape(), held.index, at);
  if (held.recorded) goOn(next);
  else edit(next, held.index);
  held.recorded = true;
}

function release() {
  const path = pen.line && pathOf(pen.line);
  letGo();
  if (path) edit(path, -1);
}

/** The first of two fingers has begun something that was not meant. */
function cancel() {
  const before = pen.held?.recorded ? pen.held.before : null;
  letGo();
  if (before) restore(before);
}

function letGo() {
  clearTimeout(pen.held?.timer);
  pen.held = pen.line = null;
  pen.hovered = -1;
  redraw();
}

function hover(place) {
  const hovered = place ? pointAt(place) : -1;
  if (hovered === pen.hovered) return;
  pen.hovered = hovered;
  redraw();
}

function again(place) {
  const index = pointAt(place);
  if (index !== newest.index || performance.now() - newest.at > DOUBLE_MS) removePoint(index);
}

function key(event, place) {
  if (event.key !== "Delete" && event.key !== "Backspace") return false;
  const under = pointAt(place);
  removePoint(under >= 0 ? under : drawing().chosen);
  return true;
}
