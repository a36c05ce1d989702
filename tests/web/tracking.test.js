import assert from "node:assert/strict";
import test from "node:test";

import { dateWords, lensGrade, planeGrade, residualWords, separationGrade } from "../../web/calibration/grades.js";
import { frameAge, mayBeTold, trackingWords } from "../../web/camera/tracking.js";

test("the state of the tracker is told in words, with how long", () => {
  assert.equal(trackingWords(null), "waiting for the rig");
  assert.equal(trackingWords({ tracking: "locked", tracking_age_s: 0 }), "locked");
  assert.equal(trackingWords({ tracking: "predicted", tracking_age_s: 0.123 }), "predicted for 0.12 s");
  assert.equal(trackingWords({ tracking: "lost", tracking_age_s: 4 }), "lost for 4.0 s");
  assert.equal(trackingWords({ tracking: "lost", tracking_age_s: null }), "lost");
});

test("somebody may say which one the robot is only while the rig stands and several look alike", () => {
  const tick = { tracking: "lost", rivals_px: [[1, 2]], rig: "held" };
  assert.ok(mayBeTold(tick));
  assert.ok(!mayBeTold({ ...tick, rig: "running" }));
  assert.ok(!mayBeTold({ ...tick, tracking: "locked" }));
  assert.ok(!mayBeTold({ ...tick, rivals_px: [] }));
  assert.ok(!mayBeTold(null));
});

test("what is on the screen is as old as the older of picture and frame", () => {
  const tick = { time_s: 10, captured_s: 8.8 };
  assert.ok(Math.abs(frameAge(0.1, tick) - 1.2) < 1e-9);
  assert.equal(frameAge(3, tick), 3);
  assert.equal(frameAge(null, tick), null);
  assert.equal(frameAge(0.2, null), 0.2);
});

test("a grade is given at its limit, and none for what is not known", () => {
  assert.deepEqual([0.3, 0.31, 1, 1.01, null, NaN].map((residual_px) => lensGrade({ residual_px })), ["good", "fair", "fair", "poor", "", ""]);
  assert.deepEqual([0.1, 0.33, 0.4].map((residual_mm) => planeGrade({ residual_mm })), ["good", "fair", "poor"]);
  assert.deepEqual([0.5, 0.2, 0.19].map(separationGrade), ["good", "fair", "poor"]);
});

test("errors too small to matter are not told to the last digit", () => {
  assert.equal(residualWords({ residual_mm: 0.0004 }), "below 0.01 mm");
  assert.equal(residualWords({ residual_mm: 0.123 }), "0.12 mm");
});

test("a date that is none is not told", () => {
  assert.equal(dateWords(null), "");
  assert.match(dateWords("2026-11-23"), /2026/);
});
