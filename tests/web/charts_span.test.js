import assert from "node:assert/strict";
import test from "node:test";
import { agoWords, clockSplits, clockTime } from "../../web/charts/clock_axis.js";
import { csvParts } from "../../web/charts/csv.js";
import { shiftedBy, shownSpan, spanWords, standsStill, toggled, zoomedBy, zoomedTo } from "../../web/charts/span.js";
import { Rows } from "../../web/live/rows.js";

const LIVE = { window_s: 60, held: null, zoom: null };

test("live, the end of what is shown is what is newest", () => {
  assert.deepEqual(shownSpan(LIVE, 100), [40, 100]);
  assert.equal(standsStill(LIVE), false);
});

test("paused, what is shown stands still while the newest goes on, until it is live again", () => {
  const paused = toggled(LIVE, 100);
  assert.deepEqual(shownSpan(paused, 250), [40, 100]);
  assert.deepEqual(toggled(paused, 250), LIVE);
});

test("a zoom stands still, too, and going live leaves it", () => {
  const zoomed = zoomedTo(LIVE, [50, 60]);
  assert.deepEqual(shownSpan(zoomed, 999), [50, 60]);
  assert.deepEqual(toggled(zoomed, 999), LIVE);
  assert.equal(zoomedTo(LIVE, [50, 50.01]), LIVE);
});

test("the time that one zooms at stays where it is", () => {
  const [from, to] = shownSpan(zoomedBy(LIVE, 100, 0.5, 55), 100);
  assert.ok(Math.abs((55 - from) / (to - from) - 15 / 60) < 1e-9);
  assert.equal(to - from, 30);
});

test("there is nothing after the newest, and no more than an hour", () => {
  assert.equal(shownSpan(shiftedBy(LIVE, 100, 30), 100)[1], 100);
  const [from, to] = shownSpan(zoomedBy(LIVE, 100, 1e6, 70), 100);
  assert.deepEqual([to - from, to], [3600, 100]);
});

test("what is shown is said in words", () => {
  assert.equal(spanWords(LIVE), "over the last 60 seconds");
  assert.equal(spanWords({ ...LIVE, window_s: 600 }), "over the last 10 minutes");
  assert.deepEqual(agoWords([0, 60], 400), ["−60 s", "−45 s", "−30 s", "−15 s", "now"]);
  assert.deepEqual(agoWords([0, 3600], 100), ["−60 min", "−30 min", "now"]);
});

test("what stands still has round times of the clock on the wall", () => {
  const clock_s = 1_700_000_000.25;
  const splits = clockSplits([10, 40], clock_s, 300);
  for (const split of splits) assert.ok(Math.abs(((split + clock_s) % 10) % 10) < 1e-6);
  assert.equal(splits.length, 3);
  assert.match(clockTime(clock_s, 1), /^\d\d:\d\d:\d\d\.3$/);
  assert.match(clockTime(clock_s), /^\d\d:\d\d:\d\d$/);
});

test("a table has the rows of the part, the columns' names with units, and empty cells for what was not known", () => {
  const rows = new Rows(["error_mm", "x_mm"], 10);
  for (let second = 0; second < 6; second += 1) rows.append(second, { error_mm: second / 8, x_mm: second === 3 ? null : second });
  assert.equal(csvParts(rows, [1.5, 3], ["error_mm", "x_mm"]).join(""), "time_s,error_mm,x_mm\n2.0000,0.2500,2.0000\n3.0000,0.3750,\n");
});
