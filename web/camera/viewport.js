/** Which part of the picture is shown, and how a box on the screen shows it. Pure. */

/**
 * @typedef {{zoom: number, u: number, v: number}} Viewport zoom: 1 shows the whole picture; u, v: what lies in the
 *   middle, as shares of the picture's width and height
 * @typedef {{width: number, height: number}} Box on the screen, px
 * @typedef {[number, number]} Size of the picture, px
 */

/** @type {Viewport} */
export const WHOLE = { zoom: 1, u: 0.5, v: 0.5 };
export const MOST_ZOOM = 12;
/** A zoom closer to 1 than this is the whole picture. */
const NEARLY = 1.02;

export const isZoomed = ({ zoom }) => zoom > 1;

/**
 * Where the picture lies in the box: as large as it goes, times the zoom.
 * @param {Viewport} view @param {Box} box @param {Size} size
 */
export function placed({ zoom, u, v }, { width, height }, size) {
  const scale = zoom * Math.min(width / size[0], height / size[1]);
  return { scale, left: width / 2 - scale * size[0] * u, top: height / 2 - scale * size[1] * v };
}

/**
 * Another zoom, with what lies under `at` (px in the box) staying there as far as the picture reaches.
 * @param {Viewport} view @param {number} zoom @param {{x: number, y: number}} at @param {Box} box @param {Size} size
 * @returns {Viewport}
 */
export function zoomedAt(view, zoom, at, box, size) {
  const next = Math.min(Math.max(zoom, 1), MOST_ZOOM);
  if (next < NEARLY) return WHOLE;
  const before = placed(view, box, size);
  const scale = (before.scale * next) / view.zoom;
  const u = ((at.x - before.left) / before.scale - (at.x - box.width / 2) / scale) / size[0];
  const v = ((at.y - before.top) / before.scale - (at.y - box.height / 2) / scale) / size[1];
  return within({ zoom: next, u, v }, box, size);
}

/**
 * The picture moved with the pointer, px on the screen.
 * @param {Viewport} view @param {number} dx @param {number} dy @param {Box} box @param {Size} size
 */
export function panned(view, dx, dy, box, size) {
  const { scale } = placed(view, box, size);
  return within({ ...view, u: view.u - dx / (scale * size[0]), v: view.v - dy / (scale * size[1]) }, box, size);
}

/**
 * Moved no further than needed to show a place (px of the picture) at least `margin` px away from the box's edge.
 * @param {Viewport} view @param {{u: number, v: number}} place @param {Box} box @param {Size} size
 */
export function showing(view, place, box, size, margin = 40) {
  if (!isZoomed(view)) return view;
  const { scale, left, top } = placed(view, box, size);
  const beyond = (at, side) => Math.max(0, margin - at) - Math.max(0, at - (side - margin));
  return panned(view, beyond(left + scale * place.u, box.width), beyond(top + scale * place.v, box.height), box, size);
}

/** No emptiness beside the picture that need not be there. */
function within({ zoom, u, v }, box, size) {
  const { scale } = placed({ zoom, u, v }, box, size);
  return { zoom, u: held(u, box.width / (scale * size[0])), v: held(v, box.height / (scale * size[1])) };
}

const held = (middle, shown) => (shown >= 1 ? 0.5 : Math.min(Math.max(middle, shown / 2), 1 - shown / 2));
