import test from "node:test";
import assert from "node:assert/strict";
import { createInstants } from "../../web/camera/instants.js";

/** A robot that goes 10 mm/s along x and turns 90 degrees/s; frames are 40 ms old when their tick comes. */
const tickAt = (time_s, more = {}) => ({
  time_s, captured_s: time_s - 0.04, tracking: "locked", window_px: [Math.round(time_s * 1000), 0, 9, 9],
  pose: { x_mm: 10 * time_s, y_mm: 0, heading_deg: wrapped(90 * time_s) }, reference: { x_mm: 10 * time_s + 1, y_mm: 0 }, ...more,
});
const wrapped = (angle) => ((((angle + 180) % 360) + 360) % 360) - 180;

function walked(from_s = 0, to_s = 2) {
  const instants = createInstants();
  for (let index = Math.round(from_s * 30); index <= to_s * 30; index += 1) instants.add(tickAt(index / 30));
  return instants;
}

test("the pose over a picture is that of its capture, between two ticks", () => {
  const instants = walked();
  for (const captured_s of [1.5, 1.512, 1.75, 1.963]) {
    const { pose, reference } = instants.at(captured_s);
    assert.ok(Math.abs(pose.x_mm - 10 * captured_s) < 1e-9);
    assert.ok(Math.abs(reference.x_mm - 10 * captured_s - 1) < 1e-9);
    assert.ok(Math.abs(wrapped(pose.heading_deg - 90 * captured_s)) < 1e-9, "also where the heading passes 180 degrees");
  }
});

test("what was seen comes from the tick that had this very frame", () => {
  const { window_px } = walked().at(1.5 - 0.04);
  assert.equal(window_px[0], 1500);
});

test("while no new frame comes, the newest tick says how it stands", () => {
  const instants = walked();
  for (let index = 61; index < 75; index += 1) instants.add(tickAt(index / 30, { captured_s: 2 - 0.04, tracking: "lost" }));
  assert.equal(instants.at(2 - 0.04).tracking, "lost");
});

test("over a picture that stands still, the overlay goes on by itself", () => {
  const instants = walked(0, 5);
  assert.equal(instants.at(3.5).pose.x_mm, 50);
});

test("a picture whose time nobody told has the newest tick", () => {
  assert.equal(walked().at(undefined).time_s, 2);
  assert.equal(createInstants().at(1), null);
});

test("the clock of another server begins anew", () => {
  const instants = walked(50, 52);
  instants.add(tickAt(0.5));
  assert.equal(instants.at(0.46).time_s, 0.5);
});

test("a robot that was put elsewhere is at one of the two places, never between them", () => {
  const instants = createInstants();
  instants.add(tickAt(1));
  instants.add(tickAt(1.1, { pose: { x_mm: 60, y_mm: 0, heading_deg: 0 } }));
  assert.ok([10, 60].includes(instants.at(1.05).pose.x_mm));
});
