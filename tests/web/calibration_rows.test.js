/** The overview of calibrations: what is measured, what is assumed, and what must be done again. */
import test from "node:test";
import assert from "node:assert/strict";
import { dayAge, rowsOf } from "../../web/calibration/rows.js";

const COIL = { field_gain: 1, sense_mA_per_count: [34.88, 34.88] };
const NEW = {
  calibration: { lens: null, plane: null },
  vision: { profile: "default", colour: { hue_deg: [340, 20] } },
  star: { in_use: { length_mm: 10, heading_offset_deg: 0, backlash_deg: 0, source: "not measured" } },
  latency: { in_use: { latency_ms: 0, source: "not measured" } },
  rig: { coils: { x: COIL, y: COIL, z: COIL, field_source: "geometry", registration: { x_mm: 0, y_mm: 0, rotation_deg: 0, magnet_reversed: false } } },
  tracking: "locked",
};
const row = (known, name) => rowsOf({ ...NEW, ...known }).find((one) => one.name === name);

test("a new rig has its colour, and everything else is assumed", () => {
  assert.deepEqual(rowsOf(NEW).map(({ name, standing }) => `${name} ${standing}`), [
    "colour done", "lens open", "plane open", "latency open", "star open", "registration open", "coils open", "sense open",
  ]);
});

test("each row leads to a step of the wizard or to a command", () => {
  for (const { step, command } of rowsOf(NEW)) assert.ok(Boolean(step) !== Boolean(command));
});

test("what was measured says how well and when", () => {
  const plane = { date: "2026-11-20", residual_mm: 0.08, source: "board", fits: true, why_not: "" };
  const found = row({ calibration: { lens: null, plane } }, "plane");
  assert.equal(found.found, "residual 0.08 mm, from the printed board");
  assert.deepEqual([found.standing, found.grade, found.date, found.why], ["done", "good", "2026-11-20", ""]);
});

test("a calibration for another camera needs attention and says why", () => {
  const lens = { date: "2026-11-20", residual_px: 0.2, views: 14, fits: false, why_not: "it was made for another camera" };
  const found = row({ calibration: { lens, plane: null } }, "lens");
  assert.deepEqual([found.standing, found.why], ["wrong", "Not used: it was made for another camera"]);
});

test("the date of a source in words is found", () => {
  const found = row({ latency: { in_use: { latency_ms: 41.2, source: "measured 2026-11-23, standard error 0.20 ms" } } }, "latency");
  assert.deepEqual([found.standing, found.date, found.found, found.why], ["done", "2026-11-23", "41.2 ms", "standard error 0.20 ms"]);
});

test("a robot that is not seen puts its colour in question", () => {
  assert.equal(row({ tracking: "lost" }, "colour").standing, "wrong");
});

test("days are counted by the calendar", () => {
  const now = new Date(2026, 10, 23, 0, 30);
  assert.equal(dayAge("2026-11-23", now), "today");
  assert.equal(dayAge(new Date(2026, 10, 22, 23, 50).toISOString(), now), "yesterday");
  assert.equal(dayAge(new Date(2026, 10, 11, 12, 0).toISOString(), now), "12 days ago");
  assert.equal(dayAge("", now), "");
});
