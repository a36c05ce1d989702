import assert from "node:assert/strict";
import test from "node:test";
import { LAST, stepAfter, STEPS } from "../../web/tour/steps.js";

test("there are three steps: the robot, the button that starts it, STOP", () => {
  assert.equal(STEPS.length, 3);
});

test("who arms is past the first step, who walks is at STOP, and who has pressed STOP needs no tour", () => {
  assert.equal(stepAfter(0, "disarmed", "armed"), 1);
  assert.equal(stepAfter(1, "armed", "running"), LAST);
  assert.equal(stepAfter(LAST, "running", "fault"), null);
});

test("nothing that happens leads back", () => {
  const states = ["disarmed", "armed", "running", "held", "fault"];
  for (const before of states) {
    for (const after of states) {
      for (let step = 0; step <= LAST; step += 1) {
        const next = stepAfter(step, before, after);
        assert.ok(next === null || next >= step, `${step}: ${before} to ${after}`);
      }
    }
  }
});

test("what the rig was before the page knew it moves nothing", () => {
  assert.equal(stepAfter(0, undefined, "running"), 0);
  assert.equal(stepAfter(0, "disarmed", undefined), 0);
});
