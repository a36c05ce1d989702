import assert from "node:assert/strict";
import test from "node:test";

import { differencesOf, flattened } from "../../web/runs/differences.js";
import { bytes, counted, lasted, nameOf, partName, remarks, when, whyNothingToReplay } from "../../web/runs/words.js";

test("sizes have three digits or fewer before their unit", () => {
  assert.deepEqual([640e3, 1.26e6, 99.94e6, 640e6, 18.3e9].map(bytes), ["640 kB", "1.3 MB", "99.9 MB", "640 MB", "18.3 GB"]);
  assert.equal(bytes(null), "–");
});

test("one is one run, none and many are runs", () => {
  assert.deepEqual([0, 1, 1200].map((count) => counted(count, "run")), ["0 runs", "1 run", "1,200 runs"]);
});

test("short runs are told in seconds, long ones by the clock", () => {
  assert.deepEqual([42.34, 99.9, 125.66].map(lasted), ["42.3 s", "99.9 s", "2:05 min"]);
});

test("the year is told when it is another one", () => {
  const now = new Date("2026-11-23T12:00:00Z");
  assert.doesNotMatch(when("2026-03-01T12:00:00Z", now), /2026/);
  assert.match(when("2025-03-01T12:00:00Z", now), /2025/);
  assert.equal(when("never", now), "–");
  assert.equal(when(null, now), "–");
});

test("a run is called by its label, or else by its id", () => {
  assert.equal(nameOf({ id: "r1", label: "eight" }), "eight");
  assert.equal(nameOf({ id: "r1", label: "" }), "r1");
  assert.deepEqual([partName("eight"), partName({ name: "letter" }), partName(null)], ["eight", "letter", "–"]);
});

test("what is saved can be replayed, and everything else says why not", () => {
  assert.equal(whyNothingToReplay({ state: "finished", recording: { state: "complete" } }), "");
  assert.equal(whyNothingToReplay({ state: "interrupted", recording: { state: "recovered" } }), "");
  for (const run of [
    { state: "running", recording: { state: "writing" } }, { state: "finished" },
    { state: "finished", recording: { state: "writing" } }, { state: "finished", recording: { state: "lost" } },
    { state: "finished", recording: { state: "a state of tomorrow" } },
  ]) {
    assert.ok(whyNothingToReplay(run).length > 20, JSON.stringify(run));
  }
});

test("a run that went well is not remarked upon, an interrupted one is", () => {
  const recording = { state: "complete" };
  assert.deepEqual(remarks({ state: "finished", reason: "the path is walked", recording }), []);
  assert.deepEqual(remarks({ state: "stopped", reason: "STOP was pressed", recording }), ["STOP was pressed"]);
  assert.equal(remarks({ state: "interrupted", recording: { state: "recovered" } }).length, 2);
});

test("settings are one level of dotted names, lists whole", () => {
  const settings = { camera: { rate_Hz: 60, size_px: [640, 480] }, name: "rig", lens: null };
  assert.deepEqual(flattened(settings), { "camera.rate_Hz": 60, "camera.size_px": [640, 480], name: "rig", lens: null });
});

test("differences are what has changed, come or gone, but not the file itself", () => {
  const then = { camera: { rate_Hz: 60, gain: null }, name: "rig", old: 1 };
  const now = { camera: { rate_Hz: 30, gain: null }, name: "rig", fresh: 2, file: { path: "rig.toml" } };
  assert.deepEqual(
    differencesOf(then, now).sort((a, b) => a.name.localeCompare(b.name)),
    [{ name: "camera.rate_Hz", then: 60, now: 30 }, { name: "fresh", then: undefined, now: 2 }, { name: "old", then: 1, now: undefined }],
  );
  assert.deepEqual(differencesOf(then, then), []);
});

test("where the rig file lies and whom the rig calls are no settings of a run", () => {
  assert.deepEqual(differencesOf({ name: "a" }, { name: "a", file: { path: "rig.toml" }, notifications: { timeout_s: 5 } }), []);
});
