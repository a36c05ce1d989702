import test from "node:test";
import assert from "node:assert/strict";
import { begun, did, redone, undone } from "../../web/draw/history.js";
import { added, distinct, inserted, isPath, moved, NOTHING, outside, parametersOf, placeOnLine, removed } from "../../web/draw/shape.js";
import { distance, lengthOf, pathOf, resampled, smoothed } from "../../web/draw/smoothing.js";

/** A small generator of the same numbers each time, 0 to 1. */
function dice(seed) {
  let state = seed;
  return () => {
    state = (state * 1664525 + 1013904223) % 2 ** 32;
    return state / 2 ** 32;
  };
}

const shaken = (line, by, roll = dice(7)) => line.map(([x, y]) => [x + by * (roll() - 0.5), y + by * (roll() - 0.5)]);
const circle = (radius, count = 200) =>
  Array.from({ length: count }, (_, index) => [radius * Math.cos((2 * Math.PI * index) / count), radius * Math.sin((2 * Math.PI * index) / count)]);
const straight = (length, apart = 0.4) => Array.from({ length: Math.round(length / apart) + 1 }, (_, index) => [index * apart, 0]);
const turnAt = (points, index) => {
  const [[a, b], [c, d], [e, f]] = [points[index - 1], points[index], points[index + 1]];
  const turn = Math.atan2(f - d, e - c) - Math.atan2(d - b, c - a);
  return Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn)));
};

test("a straight line by a shaking hand becomes straight, from end to end", () => {
  const { points, closed } = pathOf(shaken(straight(80), 1));
  assert.equal(closed, false);
  assert.ok(Math.max(...points.map(([, y]) => Math.abs(y))) < 0.5);
  assert.ok(distance(points[0], [0, 0]) < 0.8 && distance(points.at(-1), [80, 0]) < 0.8);
});

test("a circle that nearly meets its beginning is closed, and keeps its size", () => {
  const { points, closed } = pathOf(shaken(circle(30), 0.8));
  assert.equal(closed, true);
  for (const [x, y] of points) assert.ok(Math.abs(Math.hypot(x, y) - 30) < 0.6, `${x}, ${y}`);
  assert.ok(distance(points[0], points.at(-1)) > 2, "the first point does not come twice");
});

test("a right angle becomes gentle, and stays where it was", () => {
  const corner = [...straight(30), ...straight(30).slice(1).map(([x]) => [30, x])];
  const smooth = smoothed(resampled(corner, 0.5), false);
  const turns = smooth.slice(1, -1).map((_, index) => turnAt(smooth, index + 1));
  assert.ok(Math.max(...turns) < 0.2, "no kink of more than 12 degrees in half a mm");
  assert.ok(Math.min(...smooth.map((point) => distance(point, [30, 0]))) < 2.5);
});

test("points are evenly apart, few enough to be dragged and close enough to keep the shape", () => {
  for (const length of [20, 80, 240]) {
    const { points } = pathOf(straight(length));
    const apart = points.slice(1).map((point, index) => distance(points[index], point));
    assert.ok(Math.max(...apart) - Math.min(...apart) < 1e-6);
    assert.ok(apart[0] > 2 && apart[0] < 9 && points.length < 60);
  }
});

test("a click that slipped is no path, and neither is a finger that rests", () => {
  assert.equal(pathOf([[1, 1]]), null);
  assert.equal(pathOf([[1, 1], [2, 2]]), null);
  assert.equal(pathOf(Array(40).fill([5, 5])), null);
});

test("resampling keeps length and ends", () => {
  const line = shaken(circle(20), 0.2);
  const again = resampled(line, 0.5);
  assert.deepEqual([again[0], again.at(-1)], [line[0], line.at(-1)]);
  assert.ok(Math.abs(lengthOf(again) - lengthOf(line)) < 0.03 * lengthOf(line));
});

test("points are added, put between, moved and removed, and the shape before stays as it was", () => {
  const three = [[0, 0], [10, 0], [10, 10]].reduce(added, NOTHING);
  assert.deepEqual(inserted(three, 1, [5, 1]).points[1], [5, 1]);
  assert.deepEqual(moved(three, 2, [9, 9]).points.at(-1), [9, 9]);
  assert.equal(removed(three, 0).points.length, 2);
  assert.equal(three.points.length, 3);
  assert.equal(NOTHING.points.length, 0);
});

test("a point on the line comes between its neighbours, on a closed one also between the last and the first", () => {
  const square = { points: [[0, 0], [10, 0], [10, 10], [0, 10]], closed: true, kind: "polyline" };
  assert.equal(placeOnLine(square, [5, 0.2]), 1);
  assert.equal(placeOnLine(square, [0.3, 5]), 4);
  assert.equal(placeOnLine({ ...square, closed: false }, [0.3, 5]), 1, "there is no such side on an open one");
});

test("a closed curve needs three different points, everything else two", () => {
  const two = { points: [[0, 0], [10, 0]], closed: false, kind: "spline" };
  assert.ok(isPath(two));
  assert.ok(!isPath({ ...two, closed: true }));
  assert.ok(isPath({ ...two, closed: true, kind: "polyline" }));
  assert.ok(!isPath({ ...two, points: [[3, 3], [3, 3]] }));
});

test("what goes to the server has no point twice and no more digits than a camera sees", () => {
  const shape = { points: [[1.23456, 0], [1.23456, 0], [9, 9], [1.2346, 0]], closed: true, kind: "polyline" };
  assert.equal(distinct(shape).length, 2);
  assert.deepEqual(parametersOf(shape, 3).points_mm, [[1.23, 0], [9, 9]]);
});

test("points beyond the limits are told by their numbers, the limit itself is inside", () => {
  assert.deepEqual(outside({ points: [[60, 0], [60.01, 0], [0, -61]] }, 60), [1, 2]);
});

test("what is undone can be redone, until something else is done", () => {
  let history = [1, 2, 3].reduce(did, begun(0));
  history = undone(undone(history));
  assert.equal(history.now, 1);
  assert.equal(redone(history).now, 2);
  assert.equal(redone(redone(redone(history))).now, 3);
  history = did(history, 9);
  assert.equal(redone(history), history);
  assert.equal(undone(begun(0)).now, 0);
});
