import test from "node:test";
import assert from "node:assert/strict";
import { measured } from "../../web/measure/distance.js";

test("a distance has two parts and a direction, and is the same there and back", () => {
  const there = measured([1, 2], [4, 6]);
  assert.deepEqual([there.distance_mm, there.dx_mm, there.dy_mm], [5, 3, 4]);
  assert.ok(Math.abs(there.angle_deg - 53.1301) < 1e-3);
  assert.equal(measured([4, 6], [1, 2]).distance_mm, 5);
  assert.equal(measured([0, 0], [0, -7]).angle_deg, -90);
});
