/** Mouse wheel, fingers and the middle button move the picture itself: zoom where they are, and pan. */

/** Zoom of one notch of a mouse wheel, which is 100 px of it. */
const WHEEL_STEP = 1.25;
/** A wheel that turns faster counts as this, px. */
const FASTEST_PX = 200;
/** A page that was scrolled so shortly ago goes on scrolling when the picture comes under the pointer, ms. */
const SCROLLING_MS = 300;
/** Pixels of a line of those mouse wheels that count in lines. */
const LINE_PX = 33;

/**
 * @param {HTMLCanvasElement} canvas
 * @param {() => import("./sight.js").Sight} sight
 * @param {() => boolean} pansWithOne whether one finger or the left button moves the picture
 */
export function createGestures(canvas, sight, pansWithOne) {
  /** @type {Map<number, {x: number, y: number}>} */
  const held = new Map();

  /** @returns {boolean} whether this moves the picture; then it points at nothing */
  function down(event) {
    const isPan = event.button === 1 || (event.button === 0 && pansWithOne() && sight().isZoomed);
    const isTouch = event.pointerType === "touch";
    if (!isPan && !isTouch) return false;
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const moves = isPan || held.size > 1;
    if (moves) event.preventDefault();
    if (moves) canvas.setPointerCapture(event.pointerId);
    return moves;
  }

  /** @returns {boolean} as `down` */
  function move(event) {
    const before = held.get(event.pointerId);
    if (!before) return false;
    const now = { x: event.clientX, y: event.clientY };
    const others = [...held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    held.set(event.pointerId, now);
    if (others.length === 0) {
      const single = event.buttons === 4 || pansWithOne();
      if (single) sight().pan(now.x - before.x, now.y - before.y);
      return single;
    }
    const [other] = others;
    sight().pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    sight().zoomTo(apart(now, other) / (apart(before, other) || 1), (now.x + other.x) / 2, (now.y + other.y) / 2);
    return true;
  }

  const up = (event) => held.delete(event.pointerId);

  let scrolledAt = -Infinity;
  const scrolled = () => (scrolledAt = performance.now());

  function wheel(event) {
    const nothing = !sight().isZoomed && event.deltaY > 0;
    const scrolling = !event.ctrlKey && performance.now() - scrolledAt < SCROLLING_MS;
    if (nothing || scrolling || event.deltaY === 0) return;
    event.preventDefault();
    const far = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * LINE_PX : event.deltaY;
    const notches = Math.max(-FASTEST_PX, Math.min(FASTEST_PX, far)) / 100;
    sight().zoomTo(WHEEL_STEP ** -notches, event.clientX, event.clientY);
  }

  // A second finger must not scroll or enlarge the page.
  const touched = (event) => event.touches.length > 1 && event.preventDefault();

  canvas.addEventListener("wheel", wheel, { passive: false });
  canvas.addEventListener("touchstart", touched, { passive: false });
  addEventListener("scroll", scrolled, { passive: true });
  const close = () => {
    canvas.removeEventListener("wheel", wheel);
    canvas.removeEventListener("touchstart", touched);
    removeEventListener("scroll", scrolled);
  };
  return { down, move, up, close };
}

const apart = (one, other) => Math.hypot(one.x - other.x, one.y - other.y);
