/** A promise and what became of it, in words. */
import test from "node:test";
import assert from "node:assert/strict";
import { grouped, promiseWords, reactionWords } from "../../web/faults/words.js";

test("a promise says what the rig does, how soon, and when no current flows", () => {
  assert.equal(
    promiseWords({ states: ["held"], noticed_ms: 104, gone_ms: 255 }),
    "The rig holds within 104 ms, and no current flows after 255 ms.",
  );
  assert.equal(promiseWords({ states: ["running", "held"], noticed_ms: null, gone_ms: null }), "The rig walks on or holds.");
});

test("a reaction says the same of what was measured", () => {
  const held = { was: "running", became: "held", noticed_ms: 101, gone_ms: 240, verdict: "kept" };
  assert.equal(reactionWords(held), "The rig holds after 101 ms, and no current flowed after 240 ms.");
  assert.equal(reactionWords({ ...held, became: null, verdict: "watching" }), "Watching…");
  assert.equal(reactionWords({ ...held, became: null, verdict: "kept" }), "The rig walks on.");
  assert.equal(reactionWords({ ...held, was: "disarmed", verdict: "at_rest" }), "No current flowed before, and none flows now.");
});

test("the list is searched by every word that is typed, and keeps its order", () => {
  const fault = (name, family, title, what) => ({ name, family, title, what });
  const faults = [
    fault("light_off", "camera", "Light off", "The lamp goes out."), fault("supply_off", "board", "Supply off", "Switched off."),
    fault("glare", "camera", "Glare", "A lamp is mirrored."),
  ];
  assert.deepEqual(grouped(faults, "LAMP off").map(([family, list]) => [family, list.map(({ name }) => name)]), [["camera", ["light_off"]]]);
  assert.deepEqual(grouped(faults, "").map(([family, list]) => [family, list.length]), [["camera", 2], ["board", 1]]);
});
