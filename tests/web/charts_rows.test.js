import assert from "node:assert/strict";
import test from "node:test";
import { History } from "../../web/live/history.js";
import { Rows } from "../../web/live/rows.js";

const NAMES = ["a", "b"];
const filled = (count, kept) => {
  const rows = new Rows(NAMES, kept);
  for (let index = 0; index < count; index += 1) rows.append(index / 10, { a: index, b: -index });
  return rows;
};

test("the newest rows are kept, however many came, and the arrays do not grow", () => {
  const rows = filled(10_007, 100);
  assert.equal(rows.length, 100);
  assert.equal(rows.newest_s, 1000.6);
  assert.equal(rows.time_s.length, 125);
  const [times, a] = rows.between(0, 2000, ["a"]);
  assert.deepEqual([times.length, a[0], a.at(-1)], [100, 9907, 10_006]);
});

test("a part is cut with one row more on each side", () => {
  const [times, b] = filled(50, 100).between(1.05, 1.95, ["b"]);
  assert.deepEqual([times[0], times.at(-1), b[0], b.at(-1)], [1, 2, -10, -20]);
});

test("before the first row there is nothing", () => {
  const rows = filled(5, 10);
  assert.equal(rows.at(-1), -1);
  assert.equal(rows.at(0.25), 2);
  assert.equal(rows.between(-9, -8, NAMES)[0].length, 1);
  assert.equal(new Rows(NAMES, 5).between(0, 1, NAMES)[0].length, 0);
});

test("what is not known is a gap, not a zero", () => {
  const rows = new Rows(NAMES, 4);
  rows.append(0, { a: null });
  rows.append(1, { a: 0, b: undefined });
  assert.ok(Number.isNaN(rows.columns.a[0]));
  assert.equal(rows.columns.a[1], 0);
  assert.ok(Number.isNaN(rows.columns.b[1]));
});

const RATE_HZ = 30;
function hour(value, seconds = 3600) {
  const history = new History(NAMES, 3600, RATE_HZ);
  for (let index = 0; index < seconds * RATE_HZ; index += 1) history.append(index / RATE_HZ, { a: value(index / RATE_HZ), b: null });
  return history;
}

test("a drawing of an hour has no more points than one of a minute", () => {
  const history = hour(Math.sin);
  const pixels = 400;
  const counts = [10, 60, 600, 3600].map((window_s) => history.drawn(3600 - window_s, 3600, pixels, ["a"])[0].length);
  for (const count of counts) assert.ok(count <= 5 * pixels, `${counts}`);
});

test("a peak of one tick is seen in a drawing of an hour", () => {
  const history = hour((time) => (Math.abs(time - 1234.5) < 1e-9 ? 77 : Math.sin(time)));
  const [, a] = history.drawn(0, 3600, 300, ["a"]);
  assert.equal(Math.max(...a), 77);
});

test("a coarse level has the extremes of the ticks in each of its pieces", () => {
  const value = (time) => Math.sin(7 * time) + time / 100;
  const history = hour(value, 40);
  const [times, a] = history.drawn(0, 40, 40, ["a"]);
  assert.equal(times[1] - times[0], 0.5);
  for (let piece = 0; piece < 39; piece += 1) {
    const own = Array.from({ length: RATE_HZ }, (_, index) => Math.fround(value(piece + index / RATE_HZ)));
    assert.deepEqual([a[2 * piece], a[2 * piece + 1]], [Math.min(...own), Math.max(...own)]);
  }
});

test("nothing is drawn across a silence, in no level", () => {
  const history = hour(() => 1, 20);
  history.append(60, { a: 1 });
  for (const pixels of [1, 10, 40, 4000]) {
    const [times, a] = history.drawn(0, 60, pixels, ["a"]);
    const gap = [...a].findIndex(Number.isNaN);
    assert.ok(gap > 0 && times[gap] > 19 && times[gap] <= 24, `${pixels} px: ${times[gap]}`);
  }
});

test("the value at a time is that of the tick before it", () => {
  const history = hour((time) => time, 10);
  assert.equal(history.valuesAt(4.05, ["a"])[0], Math.fround(4 + 1 / 30));
  assert.deepEqual(history.valuesAt(5, ["b", "a"]), [null, 5]);
  assert.deepEqual(history.valuesAt(-1, ["a"]), [null]);
});
