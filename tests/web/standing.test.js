import assert from "node:assert/strict";
import test from "node:test";
import { somethingWaits, standingOf } from "../../web/run/standing.js";

const run = { controller: { name: "geometric", parameters: { gain: 3 } }, trajectory: { name: "eight", parameters: { width_mm: 80 } }, gait: { sweep_deg: 30, approach: false } };
const SWEEP = /** @type {any} */ ({ name: "sweep_deg", kind: "number", unit: "°", live: true });
const APPROACH = /** @type {any} */ ({ name: "approach", kind: "switch", unit: "", live: false });
const now = (change = {}) => ({ selection: run, walked: run, occupied: false, applying: {}, ...change });
const withGait = (gait) => ({ ...run, gait: { ...run.gait, ...gait } });

test("without a run nothing is said of a value", () => {
  assert.equal(standingOf(now({ walked: null }), "gait", SWEEP), null);
});

test("a value that may change at once says so quietly, then that it is on its way, then that it is in the run", () => {
  const state = (change) => standingOf(now(change), "gait", SWEEP);
  assert.deepEqual(state({}), { state: "quiet", words: "applies at once" });
  const edited = { selection: withGait({ sweep_deg: 20 }) };
  assert.equal(state({ ...edited, applying: { "gait.sweep_deg": "pending" } })?.state, "pending");
  assert.deepEqual(state({ ...edited, walked: withGait({ sweep_deg: 20 }), applying: { "gait.sweep_deg": "applied" } }), { state: "applied", words: "in this run" });
});

test("a value that the run did not take shows what the run has", () => {
  assert.deepEqual(standingOf(now({ selection: withGait({ sweep_deg: 20 }) }), "gait", SWEEP), { state: "waits", words: "this run has 30°" });
});

test("what is not safe to change waits for the next run, and so does everything while a study has the rig", () => {
  const waits = { state: "waits", words: "for the next run" };
  assert.deepEqual(standingOf(now({ selection: withGait({ approach: true }) }), "gait", APPROACH), waits);
  assert.deepEqual(standingOf(now({ selection: withGait({ sweep_deg: 20 }), occupied: true }), "gait", SWEEP), waits);
});

test("the values of another controller are not those of the run", () => {
  const other = { ...run, controller: { name: "hold", parameters: { gain: 2 } } };
  const gain = /** @type {any} */ ({ name: "gain", kind: "number", unit: "1/s", live: true });
  assert.equal(standingOf(now({ selection: other }), "controller", gain)?.state, "quiet");
  assert.ok(somethingWaits(other, run));
});

test("the order in which values are listed makes no difference", () => {
  assert.ok(!somethingWaits({ ...run, gait: { approach: false, sweep_deg: 30 } }, run));
  assert.ok(somethingWaits(withGait({ sweep_deg: 31 }), run));
});
