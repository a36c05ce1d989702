/** From the line of a hand to a path that a robot can walk: shaking is taken out, corners become gentle. Pure, in mm. */

/** @typedef {[number, number]} Point */

/** The hand's line is known at points so far apart. */
const FINE_MM = 0.5;
/** Corners are rounded, and shaking averaged, over about this length either way. */
const GENTLE_MM = 2;
/** Points of the path: so many where that leaves them within these distances. */
const POINTS = 30;
const CLOSEST_MM = 3;
const FARTHEST_MM = 8;
/** A line that ends so near to where it began, and is much longer, is meant to be closed. */
const CLOSING_MM = 6;
const LOOP_MM = 40;
/** A line shorter than this is a click that slipped. */
const SHORTEST_MM = 4;

/**
 * @param {Point[]} line as it was drawn
 * @returns {{points: Point[], closed: boolean, kind: "spline"} | null} null for what is too short to be a path
 */
export function pathOf(line) {
  const length = lengthOf(line);
  if (!(length >= SHORTEST_MM)) return null;
  const closed = length >= LOOP_MM && distance(line[0], line[line.length - 1]) <= CLOSING_MM;
  const whole = closed ? [...line, line[0]] : line;
  const smooth = smoothed(resampled(whole, FINE_MM), closed);
  const around = lengthOf(smooth);
  const apart = Math.min(Math.max(around / POINTS, CLOSEST_MM), FARTHEST_MM);
  const points = resampled(smooth, apart);
  return { points: closed ? points.slice(0, -1) : points, closed, kind: "spline" };
}

export const distance = ([x, y], [p, q]) => Math.hypot(p - x, q - y);

export const lengthOf = (line) => line.slice(1).reduce((sum, point, index) => sum + distance(line[index], point), 0);

/**
 * Points along the line at equal distances, nearest to `apart`; both ends stay.
 * @param {Point[]} line @param {number} apart @returns {Point[]}
 */
export function resampled(line, apart) {
  const length = lengthOf(line);
  const pieces = Math.max(1, Math.round(length / apart));
  /** @type {Point[]} */
  const points = [line[0]];
  let [index, before] = [0, 0];
  for (let number = 1; number < pieces; number += 1) {
    const at = (length * number) / pieces;
    let side = distance(line[index], line[index + 1]);
    while (before + side < at && index < line.length - 2) {
      before += side;
      index += 1;
      side = distance(line[index], line[index + 1]);
    }
    points.push(mixed(line[index], line[index + 1], side > 0 ? (at - before) / side : 0));
  }
  return [...points, line[line.length - 1]];
}

/** @returns {Point} */
const mixed = ([x, y], [p, q], share) => [x + share * (p - x), y + share * (q - y)];

/**
 * Each point the mean of its neighbourhood, weighed by Gauss's curve; ends of an open line stay where they are.
 * @param {Point[]} line at equal distances; a closed one ends where it begins @param {boolean} closed @returns {Point[]}
 */
export function smoothed(line, closed) {
  const sigma = GENTLE_MM / (lengthOf(line) / (line.length - 1));
  const reach = Math.ceil(3 * sigma);
  const weights = Array.from({ length: 2 * reach + 1 }, (_, index) => Math.exp(-0.5 * ((index - reach) / sigma) ** 2));
  const total = weights.reduce((sum, weight) => sum + weight, 0);
  const neighbour = closed ? around(line) : mirrored(line);
  return line.map((_, at) => {
    let [x, y] = [0, 0];
    weights.forEach((weight, index) => {
      const [p, q] = neighbour(at + index - reach);
      x += weight * p;
      y += weight * q;
    });
    return [x / total, y / total];
  });
}

const around = (line) => {
  const count = line.length - 1;
  return (index) => line[((index % count) + count) % count];
};

/** Beyond an end the line goes on as if turned about it, so that the end keeps its place and direction. */
const mirrored = (line) => {
  const last = line.length - 1;
  const turned = ([x, y], [p, q]) => [2 * x - p, 2 * y - q];
  return (index) => {
    if (index < 0) return turned(line[0], line[Math.min(-index, last)]);
    return index > last ? turned(line[last], line[Math.max(2 * last - index, 0)]) : line[index];
  };
};
