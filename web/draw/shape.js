/** The path that is drawn, as an immutable value: points in mm, closed or open, curved or straight between them. Pure. */
import { distance } from "./smoothing.js";

/**
 * @typedef {[number, number]} Point
 * @typedef {{points: Point[], closed: boolean, kind: "spline" | "polyline"}} Shape
 */

/** @type {Shape} */
export const NOTHING = { points: [], closed: false, kind: "spline" };

/** Points closer together than this are one and the same, mm; the server refuses them. */
const SAME_MM = 0.01;
/** The server takes no more. */
export const MOST_POINTS = 2000;

/** @param {Shape} shape @param {number} index before which it comes @param {Point} point @returns {Shape} */
export const inserted = (shape, index, point) => ({ ...shape, points: shape.points.toSpliced(index, 0, point) });

/** @param {Shape} shape @param {Point} point @returns {Shape} */
export const added = (shape, point) => inserted(shape, shape.points.length, point);

/** @param {Shape} shape @param {number} index @param {Point} point @returns {Shape} */
export const moved = (shape, index, point) => ({ ...shape, points: shape.points.with(index, point) });

/** @param {Shape} shape @param {number} index @returns {Shape} */
export const removed = (shape, index) => ({ ...shape, points: shape.points.toSpliced(index, 1) });

/** A closed curve needs three points to have an inside, every other path two. @param {Shape} shape */
export const fewest = ({ closed, kind }) => (closed && kind === "spline" ? 3 : 2);

/** @param {Shape} shape */
export const isPath = (shape) => distinct(shape).length >= fewest(shape);

/** Without points that lie on the one before them. @param {Shape} shape @returns {Point[]} */
export function distinct({ points, closed }) {
  const kept = points.filter((point, index) => index === 0 || distance(points[index - 1], point) > SAME_MM);
  const returns = closed && kept.length > 1 && distance(kept[0], kept[kept.length - 1]) <= SAME_MM;
  return returns ? kept.slice(0, -1) : kept;
}

/**
 * As the server's waypoints take it; hundredths of a mm are finer than any camera sees.
 * @param {Shape} shape @param {number} speed_mm_s
 */
export const parametersOf = (shape, speed_mm_s) => ({
  points_mm: distinct(shape).map(([x, y]) => [rounded(x), rounded(y)]), closed: shape.closed, kind: shape.kind, speed_mm_s,
});

const rounded = (value) => Math.round(value * 100) / 100;

/** Which points lie beyond the plate's limits. @param {Shape} shape @param {number} half_mm @returns {number[]} */
export const outside = ({ points }, half_mm) =>
  points.flatMap(([x, y], index) => (Math.abs(x) <= half_mm && Math.abs(y) <= half_mm ? [] : [index]));

/** Before which point a new one on the line comes: on the nearest side. @param {Shape} shape @param {Point} at */
export function placeOnLine({ points, closed }, at) {
  const sides = points.length - (closed ? 0 : 1);
  const distances = Array.from({ length: sides }, (_, index) => toSide(at, points[index], points[(index + 1) % points.length]));
  return distances.indexOf(Math.min(...distances)) + 1;
}

/** From a point to a straight side. */
export function toSide([x, y], [a, b], [c, d]) {
  const square = (c - a) ** 2 + (d - b) ** 2;
  const share = square > 0 ? Math.min(Math.max(((x - a) * (c - a) + (y - b) * (d - b)) / square, 0), 1) : 0;
  return Math.hypot(a + share * (c - a) - x, b + share * (d - b) - y);
}
