/** How a canvas shows a picture: where in it somebody points, and which part of it is shown. */
import { isZoomed, panned, placed, showing, WHOLE, zoomedAt } from "./viewport.js";

/**
 * @param {HTMLCanvasElement} canvas
 * @param {import("./zoom.js").Zoom} zoom
 * @param {() => [number, number] | null} sizeOf the picture, px
 */
export function createSight(canvas, zoom, sizeOf) {
  const box = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });
  /** @returns {[number, number]} */
  const size = () => sizeOf() ?? [canvas.clientWidth, canvas.clientHeight];
  const zoomAt = (factor, at) => zoom.set(zoomedAt(zoom.get(), zoom.get().zoom * factor, at, box(), size()));
  const pan = (dx, dy) => zoom.set(panned(zoom.get(), dx, dy, box(), size()));
  return {
    /** @returns {import("./pointing.js").Place | null} null beside the picture, unless it is to be clamped */
    place(event, { clamped = false } = {}) {
      return sizeOf() && placeOf(event, canvas, size(), zoom.get(), clamped);
    },
    /** The picture follows a pointer, px on the screen. */
    pan,
    /** Closer by a factor at a place of the page, px. */
    zoomTo(factor, clientX, clientY) {
      const { left, top } = canvas.getBoundingClientRect();
      zoomAt(factor, { x: clientX - left, y: clientY - top });
    },
    /** Closer by a factor in the middle of what is shown. */
    step: (factor) => zoomAt(factor, { x: box().width / 2, y: box().height / 2 }),
    /** By shares of what is shown, as if one looked to the right and down. */
    look: (right, down) => pan(-right * box().width, -down * box().height),
    /** What lies out of sight comes into it. */
    reveal: (place) => zoom.set(showing(zoom.get(), place, box(), size())),
    fit: () => zoom.set(WHOLE),
    get isZoomed() {
      return isZoomed(zoom.get());
    },
    get size() {
      return size();
    },
    /** A CSS pixel in camera pixels. */
    get pixel() {
      return 1 / placed(zoom.get(), box(), size()).scale;
    },
  };
}

/** @typedef {ReturnType<typeof createSight>} Sight */

function placeOf(event, canvas, size, view, clamped) {
  const box = canvas.getBoundingClientRect();
  const { scale, left, top } = placed(view, box, size);
  const u = (event.clientX - box.left - left) / scale;
  const v = (event.clientY - box.top - top) / scale;
  const within = (value, most) => Math.min(Math.max(value, 0), most - 1);
  const inside = u >= 0 && v >= 0 && u < size[0] && v < size[1];
  return inside || clamped ? { u: within(u, size[0]), v: within(v, size[1]), pixel: 1 / scale } : null;
}
