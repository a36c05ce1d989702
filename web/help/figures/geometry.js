/** Points, arcs and arrow heads of the figures, in a picture whose y goes down and whose angles go the usual way. Pure. */

const RADIANS = Math.PI / 180;

/** @typedef {[number, number]} Point */

/** @param {Point} centre @param {number} radius @param {number} angle ° @returns {Point} */
export const polar = ([x, y], radius, angle) => [x + radius * Math.cos(angle * RADIANS), y - radius * Math.sin(angle * RADIANS)];

const text = (value) => String(Math.round(value * 100) / 100);

/** @param {Point[]} points */
export const polyline = (points) => points.map(([x, y], index) => `${index === 0 ? "M" : "L"}${text(x)} ${text(y)}`).join("");

/** From one angle to another, ° */
export function arc(centre, radius, from, to) {
  const [[startX, startY], [endX, endY]] = [polar(centre, radius, from), polar(centre, radius, to)];
  const large = Math.abs(to - from) > 180 ? 1 : 0;
  const turn = to > from ? 0 : 1;
  return `M${text(startX)} ${text(startY)}A${text(radius)} ${text(radius)} 0 ${large} ${turn} ${text(endX)} ${text(endY)}`;
}

/** The head of an arrow that ends at a point, coming from a direction given as another point. */
export function head([x, y], [fromX, fromY], size = 7) {
  const angle = Math.atan2(y - fromY, x - fromX);
  /** @param {number} turn @returns {Point} */
  const corner = (turn) => [x - size * Math.cos(angle + turn), y - size * Math.sin(angle + turn)];
  return `${polyline([[x, y], corner(0.45), corner(-0.45)])}Z`;
}

/** Points of a curve given by its parameter, from 0 to 1. @param {(share: number) => Point} of @returns {Point[]} */
export const sampled = (of, count = 60) => Array.from({ length: count + 1 }, (_, index) => of(index / count));
