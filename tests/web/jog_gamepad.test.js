/** The stick that is tilted chooses the end, how far it is tilted the rate, and a shoulder button must be held. */
import test from "node:test";
import assert from "node:assert/strict";
import { createStickWatch, firstPad, readPad } from "../../web/jog/gamepad.js";

const FASTEST = 60;

function pad({ left = 0, right = 0, held = /** @type {number[]} */ ([]), connected = true, mapping = "standard" } = {}) {
  const buttons = Array.from({ length: 17 }, (_, button) => ({ pressed: held.includes(button) }));
  return { connected, mapping, axes: [left, 0, right, 0], buttons };
}

test("to the left is counter-clockwise, at full tilt with the whole rate", () => {
  assert.deepEqual(readPad(pad({ left: -1, held: [4] }), FASTEST), { deadMan: true, pivot: 1, rate_deg_s: FASTEST });
  assert.deepEqual(readPad(pad({ right: 1, held: [5] }), FASTEST), { deadMan: true, pivot: -1, rate_deg_s: -FASTEST });
});

test("a stick that is nearly at rest, or that says nothing, asks for nothing", () => {
  for (const left of [0, 0.19, -0.19, NaN, undefined]) {
    assert.equal(readPad(pad({ left }), FASTEST).rate_deg_s, 0);
  }
});

test("the rate grows with the tilt from zero on, without a step, and no further than the whole", () => {
  const rates = [0.2, 0.3, 0.6, 1, 1.2].map((left) => -readPad(pad({ left }), FASTEST).rate_deg_s);
  assert.deepEqual([...rates].sort((a, b) => a - b), rates);
  assert.ok(rates[0] < 1e-9);
  assert.equal(rates.at(-1), FASTEST);
});

test("only a gamepad that is there and whose layout is known is read", () => {
  const good = pad();
  assert.equal(firstPad([null, pad({ connected: false }), pad({ mapping: "" }), good]), good);
  assert.equal(firstPad([]), null);
});

/** What a watch does over a row of looks: "+" press, "=" change, "-" release, "." nothing. */
function story(looks, stopAfter = -1) {
  let held = false;
  let did = "";
  const watch = createStickWatch({
    press: () => ((held = true), (did += "+")), change: () => (did += "="),
    release: () => ((held = false), (did += "-")), isHeld: () => held,
  });
  return looks.map((look, index) => {
    did = "";
    watch(look, (read) => read, FASTEST);
    if (index === stopAfter) held = false;
    return did || ".";
  }).join("");
}

const REST = pad();
const READY = pad({ held: [4] });
const TILTED = pad({ left: -1 });
const DRIVING = pad({ left: -1, held: [4] });

test("button and stick together drive, either let go stops", () => {
  assert.equal(story([REST, READY, DRIVING, DRIVING, READY, DRIVING]), "..+=-.");
  assert.equal(story([REST, DRIVING, TILTED, DRIVING, REST, DRIVING]), ".+-+-+");
});

test("a gamepad that is pulled out stops, and does not drive when it comes back with the button held", () => {
  assert.equal(story([REST, DRIVING, null, DRIVING, REST, DRIVING]), ".+-..+");
});

test("what is held down from before starts nothing", () => {
  assert.equal(story([DRIVING, DRIVING, REST, DRIVING]), "...+");
});

test("after a stop from elsewhere the button must be let go first", () => {
  assert.equal(story([REST, DRIVING, DRIVING, DRIVING, REST, DRIVING], 1), ".+...+");
});
