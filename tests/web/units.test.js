import assert from "node:assert/strict";
import test from "node:test";

import { clock, fixed, quantity, unitSign, wrapDegrees } from "../../web/units.js";

test("what is not a number is shown as not known", () => {
  for (const unknown of [null, undefined, NaN, Infinity, "12"]) {
    assert.equal(fixed(unknown), "–");
    assert.equal(clock(unknown), "–");
  }
});

test("a number keeps its decimals, so that nothing jumps", () => {
  assert.equal(fixed(12), "12.0");
  assert.equal(fixed(0.005, 2), "0.01");
  assert.equal(fixed(3.14159, 3), "3.142");
});

test("below zero stands a true minus, and nothing is ever minus zero", () => {
  assert.equal(fixed(-0.4), "−0.4");
  assert.equal(fixed(-0.04), "0.0");
  assert.equal(fixed(-0), "0.0");
});

test("degrees stand close to their number, other units apart", () => {
  assert.equal(quantity(87.24, "deg"), "87.2°");
  assert.equal(quantity(1.5, "mT"), "1.5 mT");
  assert.equal(quantity(114.6, "deg/s"), "114.6 °/s");
});

test("the unit of a bare number is nothing, an unknown one stays as it is", () => {
  assert.equal(unitSign("1"), "");
  assert.equal(unitSign(undefined), "");
  assert.equal(unitSign("mm/s²"), "mm/s²");
});

test("a clock counts minutes and seconds and never goes below zero", () => {
  assert.equal(clock(42.9), "0:42");
  assert.equal(clock(725), "12:05");
  assert.equal(clock(-3), "0:00");
});

test("an angle stays the same direction in one turn", () => {
  for (let angle = -1000; angle <= 1000; angle += 7.5) {
    const wrapped = wrapDegrees(angle);
    assert.ok(wrapped >= -180 && wrapped < 180, `${angle} became ${wrapped}`);
    assert.ok(Math.abs((angle - wrapped) / 360 - Math.round((angle - wrapped) / 360)) < 1e-9);
  }
});
