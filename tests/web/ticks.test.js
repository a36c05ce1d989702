import assert from "node:assert/strict";
import test from "node:test";

import { near } from "../../web/live/ticks.js";

test("an angle is told on the turn nearest to its neighbour, so that two curves of one angle stay together", () => {
  assert.equal(near(-179, 179), 181);
  assert.equal(near(179, -179), -181);
  assert.equal(near(10, 730), 730);
});

test("the first angle stands in the turn around zero", () => {
  assert.equal(near(350, null), -10);
  assert.equal(near(-181, null), 179);
});

test("what is not known stays so", () => {
  for (const unknown of [null, undefined]) assert.equal(near(unknown, 12), null);
});

test("it is always the same direction, and never half a turn away", () => {
  for (let angle = -720; angle <= 720; angle += 31) {
    for (let heading = -500; heading <= 500; heading += 77) {
      const turns = (near(angle, heading) - angle) / 360;
      assert.ok(Math.abs(turns - Math.round(turns)) < 1e-9);
      assert.ok(Math.abs(near(angle, heading) - heading) <= 180);
    }
  }
});
