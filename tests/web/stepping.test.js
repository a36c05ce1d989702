import assert from "node:assert/strict";
import test from "node:test";
import { stepOf, stepped, stepsOfKey } from "../../web/forms/stepping.js";

const sweep = /** @type {any} */ ({ name: "sweep_deg", low: 1, high: 350, initial: 30, step: 1 });
const field = /** @type {any} */ ({ name: "field_mT", above: 0, below: 15, initial: 10, step: 0.5 });

test("a step goes to the next multiple, also from a value between two", () => {
  assert.equal(stepped(sweep, 30, 1), 31);
  assert.equal(stepped(sweep, 22.5, 1), 23);
  assert.equal(stepped(sweep, 22.5, -1), 22);
});

test("a hundred small steps come out without a tail", () => {
  const gain = /** @type {any} */ ({ above: 0, high: 100, step: 0.1 });
  let value = 3;
  for (let count = 0; count < 100; count += 1) value = stepped(gain, value, 1);
  assert.equal(value, 13);
});

test("no number of steps leaves the range, and an open end is never reached", () => {
  assert.equal(stepped(sweep, 345, 10), 350);
  assert.equal(stepped(sweep, 3, -10), 1);
  const [most, least] = [stepped(field, 14.5, 10), stepped(field, 0.5, -10)];
  assert.ok(most < 15 && most > 14.5);
  assert.ok(least > 0 && least < 0.5);
});

test("a field that is empty begins at its default, or at the lowest that is allowed", () => {
  assert.equal(stepped(sweep, null, 1), 31);
  assert.equal(stepped(/** @type {any} */ ({ low: 4, high: 8, step: 1 }), null, 1), 5);
});

test("without a step in the schema a number moves by about a tenth of itself, a whole one by one", () => {
  assert.equal(stepOf(/** @type {any} */ ({}), 80), 1);
  assert.equal(stepOf(/** @type {any} */ ({}), 0.1), 0.01);
  assert.equal(stepOf(/** @type {any} */ ({}), 0), 0.1);
  assert.equal(stepOf(/** @type {any} */ ({ integer: true }), 24), 1);
});

test("arrows step, with Shift and by page ten at a time, and with other modifiers not at all", () => {
  const key = (name, more = {}) => stepsOfKey(/** @type {any} */ ({ key: name, ...more }));
  assert.deepEqual(["ArrowUp", "ArrowDown", "PageUp", "PageDown", "a"].map((name) => key(name)), [1, -1, 10, -10, 0]);
  assert.equal(key("ArrowDown", { shiftKey: true }), -10);
  assert.equal(key("ArrowUp", { ctrlKey: true }), 0);
});
