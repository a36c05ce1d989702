import assert from "node:assert/strict";
import test from "node:test";
import { extent, roomy, traceDots, traceLine } from "../../web/charts/pixels.js";

/** A pen that remembers: "M x y" and "L x y". */
function penOf() {
  const strokes = [];
  return { strokes, moveTo: (x, y) => strokes.push(["M", x, y]), lineTo: (x, y) => strokes.push(["L", x, y]) };
}
const same = (value) => value;
const line = (times, values, toX = same) => {
  const pen = penOf();
  traceLine(times, values, toX, same, pen);
  return pen.strokes;
};

test("few values are joined one after the other", () => {
  assert.deepEqual(line([0, 5, 9], [1, 2, 3]), [["M", 0, 1], ["L", 5, 2], ["L", 9, 3]]);
});

test("a gap is neither null nor NaN drawn over; undefined belongs to another curve", () => {
  for (const gap of [null, NaN]) {
    assert.deepEqual(line([0, 1, 2, 3], [1, gap, 2, 3]).map(([pen]) => pen), ["M", "M", "L"]);
  }
  assert.deepEqual(line([0, 1, 2], [1, undefined, 2]), [["M", 0, 1], ["L", 2, 2]]);
  assert.deepEqual(line([0, 1], [null, NaN]), []);
});

test("however many values, a pixel column has at most four points, and keeps its extremes", () => {
  const count = 100_000;
  const times = Float64Array.from({ length: count }, (_, index) => index);
  const values = Float32Array.from(times, (time) => Math.sin(time * 1.7) * time);
  const drawn = line(times, values, (time) => (time / count) * 200);
  const columns = Map.groupBy(drawn, ([, x]) => x);
  assert.ok(columns.size <= 201);
  for (const points of columns.values()) assert.ok(points.length <= 4);
  const heights = drawn.map(([, , y]) => y);
  assert.deepEqual([Math.min(...heights), Math.max(...heights)], extent([values]));
});

test("a dot a cell, the same ones while the window moves on", () => {
  const times = Array.from({ length: 300 }, (_, index) => index / 30);
  const dots = (from) => {
    const pen = penOf();
    const cut = times.slice(from);
    traceDots(cut, cut.map((time) => (time === 5 ? NaN : 1)), same, same, pen, 0.5);
    return pen.strokes.filter(([kind]) => kind === "M").map(([, x]) => x);
  };
  assert.equal(dots(0).length, 20);
  assert.deepEqual(dots(50).slice(1), dots(0).slice(-dots(50).length + 1));
});

test("the extent knows neither gaps nor an order", () => {
  assert.deepEqual(extent([[NaN, 3, null], [undefined, -2]]), [-2, 3]);
  assert.equal(extent([[NaN], []]), null);
});

test("an axis spans its least, and a distance begins at zero", () => {
  assert.deepEqual(roomy([1, 1], 4, true), [0, 4]);
  assert.deepEqual(roomy(null, 4, false), [0, 4]);
  const [low, high] = roomy([10, 10.1], 4, false);
  assert.ok(high - low >= 4 && low < 10 && high > 10.1);
});
