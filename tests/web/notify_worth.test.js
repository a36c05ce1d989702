/** What is told to somebody who is not looking: faults and ends, and nothing that a person has just done. */
import test from "node:test";
import assert from "node:assert/strict";
import { worthTelling } from "../../web/notify/worth.js";

const fault = (more) => worthTelling({ type: "event", severity: "error", code: "camera", message: "no frame for 120 ms", ...more });
const study = (more) => worthTelling({ type: "study", event: "ended", study: { id: "s", name: "Tilt", state: "finished", reason: "", done: 18, total: 18, failed: 0, ...more } });
const run = (event, more) => worthTelling({ type: "run", event, run: { id: "r", label: "", state: event, reason: "", unattended: true, ...more } });

test("a fault is told, but not the emergency stop that a person has pressed", () => {
  assert.deepEqual(fault(), { title: "Fault", text: "No frame for 120 ms", tag: "fault camera", tab: "log" });
  assert.equal(fault({ code: "estop" }), null);
  assert.equal(fault({ severity: "warn" }), null);
});

test("the end of a study is told with what came of it", () => {
  assert.equal(study().text, "Tilt: 18 of 18 runs");
  assert.equal(study({ state: "failed", done: 4, failed: 3, reason: "3 runs failed in a row" }).text, "Tilt: 4 of 18 runs, 3 failed, 3 runs failed in a row");
  assert.equal(worthTelling({ type: "study", event: "progress", study: {} }), null);
});

test("of runs only the end of an unattended one is told", () => {
  assert.equal(run("finished").title, "Run finished");
  assert.equal(run("started"), null);
  assert.equal(run("finished", { unattended: false }), null);
  assert.equal(worthTelling({ type: "run", event: "listed", run: null }), null);
});

test("everything else is worth nothing", () => {
  for (const type of ["tick", "rig", "server", "clock"]) assert.equal(worthTelling({ type }), null);
});
