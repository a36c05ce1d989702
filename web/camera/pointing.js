/**
 * What a click into the camera picture means just now, and what else is drawn there. Whoever needs a place in the
 * picture takes the pointer and gives it back; of several the one that took it last has it.
 */
import { html, useEffect, useRef, useState } from "../view.js";

/** {words, press(place), move?(place), release?()}; a place is {u, v, pixel} in camera pixels. A press that answers
    true has taken hold of something, which follows the keys until Enter lets it go. */
const takers = [];
/** What a layer answers that does not want the overlay over it. */
export const ALONE = "alone";
/** draw({context, pixel, picture, size, project}), over the picture and under the overlay. */
const layers = new Set();
const listeners = new Set();

const changed = () => listeners.forEach((listener) => listener());

/** Hears of a new taker or layer, and of a layer that wants to be drawn again. */
export function onPointingChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export const drawnLayers = () => layers;
export const redraw = changed;

/** Takes the pointer while `taker` is not null. behind: gives way to every other taker. */
export function usePointer(taker, { behind = false } = {}) {
  const newest = useRef(taker);
  newest.current = taker;
  const wanted = taker !== null;
  useEffect(() => {
    if (!wanted) return undefined;
    const own = () => newest.current;
    if (behind) takers.unshift(own);
    else takers.push(own);
    changed();
    return () => {
      takers.splice(takers.indexOf(own), 1);
      changed();
    };
  }, [wanted, behind]);
  useEffect(changed, [taker?.words]);
}

/** Draws over the picture while the component is there; `what` is everything that the drawing depends on. */
export function useLayer(draw, what) {
  const newest = useRef(draw);
  newest.current = draw;
  useEffect(() => {
    const own = (pen) => newest.current(pen);
    layers.add(own);
    return () => {
      layers.delete(own);
      changed();
    };
  }, []);
  useEffect(changed, what);
}

/** Redraws the component when the pointer changes hands. */
export function useTaker() {
  const [, count] = useState(0);
  useEffect(() => onPointingChange(() => count((before) => before + 1)), []);
  return takers.at(-1)?.() ?? null;
}

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** A step of the crosshair with Shift held, px; one without. */
const LONG_STEP = 10;

/** Arrow keys move a crosshair, Enter presses at it: pointing without a mouse. dragging: ref, what follows it. */
function keysOf(taker, painter, cross, setCross, dragging) {
  const enter = (place) => {
    dragging.current = !dragging.current && taker.press(place) === true;
    if (!dragging.current) taker.release?.();
  };
  return (event) => {
    if (!taker) return;
    const step = STEPS[event.key];
    const { size, pixel } = painter();
    const at = cross ?? { u: size[0] / 2, v: size[1] / 2 };
    if (step) {
      const far = event.shiftKey ? LONG_STEP : 1;
      const next = { u: within(at.u + far * step[0], size[0]), v: within(at.v + far * step[1], size[1]) };
      setCross(next);
      if (dragging.current) taker.move?.({ ...next, pixel });
    } else if (event.key === "Enter") enter({ ...at, pixel });
    else return;
    event.preventDefault();
  };
}

const within = (value, size) => Math.min(Math.max(value, 0), size - 1);

/**
 * The canvas of the picture, with mouse, finger and keys.
 * @param props canvas: ref; painter: () => the painter, with `place(event)`, `size` and `pixel`; label
 */
export function PointedCanvas({ canvas, painter, label }) {
  const taker = useTaker();
  const [cross, setCross] = useState(null);
  const held = useRef(false);
  const dragging = useRef(false);
  const leave = () => {
    if (dragging.current) taker?.release?.();
    dragging.current = false;
    setCross(null);
  };
  useLayer((pen) => taker && cross && drawCross(pen, cross), [taker?.words, cross]);
  const press = (event) => {
    if (!taker || event.button !== 0) return;
    const place = painter().place(event);
    if (!place) return;
    held.current = true;
    setCross(null);
    event.target.setPointerCapture(event.pointerId);
    taker.press(place);
  };
  const move = (event) => held.current && taker?.move?.(painter().place(event, { clamped: true }));
  const release = () => {
    if (held.current) taker?.release?.();
    held.current = false;
  };
  return html`
    <canvas ref=${canvas} role="img" aria-label=${label} tabindex=${taker ? 0 : -1} data-pointing=${taker ? "yes" : "no"}
      onPointerDown=${press} onPointerMove=${move} onPointerUp=${release} onPointerCancel=${release}
      onKeyDown=${keysOf(taker, painter, cross, setCross, dragging)} onBlur=${leave}></canvas>
  `;
}

function drawCross({ context, pixel }, { u, v }) {
  const arm = 14 * pixel;
  for (const [colour, width] of [["#10151b", 3.6], ["#ffffff", 1.5]]) {
    context.beginPath();
    context.moveTo(u - arm, v);
    context.lineTo(u + arm, v);
    context.moveTo(u, v - arm);
    context.lineTo(u, v + arm);
    context.strokeStyle = colour;
    context.lineWidth = width * pixel;
    context.stroke();
  }
}
