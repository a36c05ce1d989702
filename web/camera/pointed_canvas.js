/** The canvas of the picture: mouse, finger and keys either point at something in it or move the picture itself. */
import { html, useEffect, useRef, useState } from "../view.js";
import { createGestures } from "./gestures.js";
import { useLayer, useTaker } from "./pointing.js";
import { useZoom } from "./zoom_hook.js";

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** A step of the crosshair with Shift held, px; one without. */
const LONG_STEP = 10;
/** Share of what is shown by which an arrow key moves a picture that nobody points at. */
const PAN_SHARE = 0.1;

/** Zoom of one press of a key or button. */
export const ZOOM_STEP = 1.5;

const within = (value, size) => Math.min(Math.max(value, 0), size - 1);

/**
 * @param props canvas: ref; sight: () => how the canvas shows its picture; zoom: of the picture; hand: whether dragging
 *        moves the picture in any case; stale: the picture is old; label
 */
export function PointedCanvas({ canvas, sight, zoom, hand, stale, label }) {
  const taker = useTaker();
  const { zoom: factor } = useZoom(zoom);
  const [cross, setCross] = useState(null);
  const pressed = useRef(null);
  const dragging = useRef(false);
  const gestures = useRef(null);
  const free = hand || !taker;
  const pansWithOne = useRef(free);
  pansWithOne.current = free;
  useEffect(() => {
    gestures.current = createGestures(canvas.current, sight, () => pansWithOne.current);
    return () => gestures.current.close();
  }, [zoom]);
  useLayer((pen) => taker && cross && drawCross(pen, cross), [taker?.words, cross]);

  const drop = (way) => {
    if (pressed.current || dragging.current) (pressed.current ?? taker)?.[way]?.();
    pressed.current = null;
    dragging.current = false;
  };
  const press = (event) => {
    if (gestures.current.down(event)) return drop(pressed.current?.cancel ? "cancel" : "release");
    if (!taker || event.button !== 0 || hand) return undefined;
    const place = sight().place(event);
    if (!place) return undefined;
    pressed.current = taker;
    setCross(null);
    event.target.setPointerCapture(event.pointerId);
    return taker.press({ ...place, touch: event.pointerType === "touch" });
  };
  const move = (event) => {
    if (gestures.current.move(event)) return;
    if (pressed.current) pressed.current.move?.(sight().place(event, { clamped: true }));
    else taker?.hover?.(sight().place(event));
  };
  const release = (event) => {
    gestures.current.up(event);
    if (pressed.current) drop("release");
  };
  const again = (event) => {
    const place = sight().place(event);
    if (free) sight().fit();
    else if (place) taker.again?.(place);
  };
  const leave = () => {
    if (dragging.current) drop("release");
    setCross(null);
  };
  const keys = (event) => {
    if (zoomKey(event, sight())) return event.preventDefault();
    const handled = taker ? pointKey(taker, event) : panKey(event, sight());
    return handled && event.preventDefault();
  };

  /** Arrow keys move a crosshair, Enter presses at it: pointing without a mouse. */
  const pointKey = (taker, event) => {
    const { size, pixel } = sight();
    const at = cross ?? { u: size[0] / 2, v: size[1] / 2 };
    const step = STEPS[event.key];
    if (event.key === "Enter") {
      dragging.current = !dragging.current && taker.press({ ...at, pixel }) === true;
      if (!dragging.current) taker.release?.();
      return true;
    }
    if (!step) return taker.key?.(event, { ...at, pixel }) ?? false;
    const far = event.shiftKey ? LONG_STEP : 1;
    const next = { u: within(at.u + far * step[0], size[0]), v: within(at.v + far * step[1], size[1]) };
    setCross(next);
    sight().reveal(next);
    if (dragging.current) taker.move?.({ ...next, pixel });
    else taker.hover?.({ ...next, pixel });
    return true;
  };

  return html`
    <canvas ref=${canvas} role="img" aria-label=${label} tabindex="0" data-pointing=${taker && !hand ? "yes" : "no"} data-zoomed=${factor > 1}
      data-stale=${stale} onPointerDown=${press} onPointerMove=${move} onPointerUp=${release} onPointerCancel=${release}
      onPointerLeave=${() => taker?.hover?.(null)} onDblClick=${again} onKeyDown=${keys} onBlur=${leave}></canvas>
  `;
}

const ZOOM_KEYS = {
  "+": (sight) => sight.step(ZOOM_STEP),
  "=": (sight) => sight.step(ZOOM_STEP),
  "-": (sight) => sight.step(1 / ZOOM_STEP),
  0: (sight) => sight.fit(),
};

/** @returns whether the key zooms */
function zoomKey(event, sight) {
  const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : ZOOM_KEYS[event.key];
  act?.(sight);
  return act !== undefined;
}

function panKey(event, sight) {
  const step = STEPS[event.key];
  if (!step || !sight.isZoomed) return false;
  sight.look(PAN_SHARE * step[0], PAN_SHARE * step[1]);
  return true;
}

function drawCross({ context, pixel }, { u, v }) {
  const arm = 14 * pixel;
  for (const [colour, width] of /** @type {[string, number][]} */ ([["#10151b", 3.6], ["#ffffff", 1.5]])) {
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
