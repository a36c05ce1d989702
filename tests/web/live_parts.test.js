/** What two tabs make of their edits, and how late what comes is. */
import test from "node:test";
import assert from "node:assert/strict";
import { createLateness } from "../../web/live/lateness.js";
import { merge } from "../../web/live/merging.js";

const BASE = { controller: { name: "geometric" }, trajectory: { name: "eight" }, gait: { sweep_deg: 10 } };

test("what only they have changed is taken over, and what I have changed stays", () => {
  const mine = { ...BASE, gait: { sweep_deg: 20 } };
  const theirs = { ...BASE, trajectory: { name: "circle" } };
  assert.deepEqual(merge(BASE, mine, theirs), {
    merged: { ...mine, trajectory: { name: "circle" } }, taken: ["trajectory"], kept: [],
  });
});

test("what both have changed stays mine, and is told", () => {
  const mine = { ...BASE, gait: { sweep_deg: 20 } };
  const theirs = { ...BASE, gait: { sweep_deg: 30 } };
  assert.deepEqual(merge(BASE, mine, theirs), { merged: mine, taken: [], kept: ["gait"] });
});

test("the same change of both is no change", () => {
  const same = { ...BASE, gait: { sweep_deg: 20 } };
  assert.deepEqual(merge(BASE, same, { ...same, gait: { sweep_deg: 20 } }), { merged: same, taken: [], kept: [] });
});

test("a message is late by as much as it comes later than the promptest", () => {
  const lateness = createLateness();
  assert.equal(lateness(50_000, 1000), 0);
  assert.ok(Math.abs(lateness(51_000, 2000)) < 20);
  assert.ok(Math.abs(lateness(52_000, 6000) - 3000) < 60);
});

test("a clock that runs a little slower than the other is not late after a day", () => {
  const lateness = createLateness();
  let late = 0;
  for (let second = 0; second < 86_400; second += 1) late = lateness(second * 995, second * 1000);
  assert.ok(late < 50, `${late} ms`);
});
