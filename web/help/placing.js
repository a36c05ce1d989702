/** Where something small stands beside what it belongs to: inside the window, under the bar, not over its target. Pure. */

/** @typedef {{left: number, top: number, right: number, bottom: number}} Rect px */

/**
 * @param {Rect} target
 * @param {{width: number, height: number}} size of what is placed
 * @param {{width: number, height: number, top: number}} room the window; top: where the bar ends
 * @param {Rect[]} [clear] what must not be covered
 * @param {number} [gap] px
 * @returns {{left: number, top: number, side: "left" | "right" | "below" | "above" | "none"}} none: nowhere beside it
 */
export function placeBeside(target, size, room, clear = [], gap = 10) {
  const middle = (target.top + target.bottom) / 2 - size.height / 2;
  const centre = (target.left + target.right) / 2 - size.width / 2;
  const tries = /** @type {const} */ ([
    ["left", target.left - gap - size.width, middle],
    ["right", target.right + gap, middle],
    ["below", centre, target.bottom + gap],
    ["above", centre, target.top - gap - size.height],
  ]);
  for (const [side, wantedLeft, wantedTop] of tries) {
    const along = side === "left" || side === "right";
    const left = along ? wantedLeft : held(wantedLeft, gap, room.width - size.width - gap);
    const top = along ? held(wantedTop, room.top + gap, room.height - size.height - gap) : wantedTop;
    const place = { left, top, right: left + size.width, bottom: top + size.height };
    if (isInside(place, room) && ![target, ...clear].some((other) => overlap(place, other))) return { left, top, side };
  }
  return { ...leastInTheWay(target, size, room, clear, gap), side: "none" };
}

const GRID_PX = 12;

/** Where there is room nowhere beside it: over as little of the target as can be, near to it, and over nothing else that matters. */
function leastInTheWay(target, size, room, clear, gap) {
  let best = { left: gap, top: Math.max(room.top + gap, room.height - size.height - gap), cost: Infinity };
  for (let top = room.top + gap; top <= room.height - size.height - gap; top += GRID_PX) {
    for (let left = gap; left <= room.width - size.width - gap; left += GRID_PX) {
      const place = { left, top, right: left + size.width, bottom: top + size.height };
      if (clear.some((other) => overlap(place, other))) continue;
      const cost = 10 * shared(place, target) + apart(place, target) ** 2;
      if (cost < best.cost) best = { left, top, cost };
    }
  }
  return { left: best.left, top: best.top };
}

/** The area that two have in common, px². */
const shared = (a, b) =>
  Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) * Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));

/** From middle to middle, px. */
const apart = (a, b) => Math.hypot(a.left + a.right - b.left - b.right, a.top + a.bottom - b.top - b.bottom) / 2;

const held = (value, low, high) => Math.max(low, Math.min(high, value));

const isInside = ({ left, top, right, bottom }, room) => left >= 0 && top >= room.top && right <= room.width && bottom <= room.height;

/** @param {Rect} a @param {Rect} b */
export const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
