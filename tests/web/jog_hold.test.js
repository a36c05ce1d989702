/** A jog lasts for as long as somebody holds something down, and nothing that is late starts it again. */
import test, { mock } from "node:test";
import assert from "node:assert/strict";
import { createHold, RENEW_MS } from "../../web/jog/hold.js";

const LEFT = { pivot: /** @type {1} */ (1), rate_deg_s: 30, tilt_deg: 25 };

/** A hold whose answers come when the test says so. */
function bench() {
  mock.timers.reset();
  mock.timers.enable({ apis: ["setInterval"] });
  const rig = { sent: [], last: [], answers: [], obstacle: "", told: null };
  const hold = createHold({
    send: (command, signal) => {
      rig.sent.push(command);
      return new Promise((resolve, reject) => rig.answers.push({ resolve, reject, signal }));
    },
    sendLast: (command) => rig.last.push(command),
    obstacle: () => rig.obstacle,
    changed: (held, refusal) => (rig.told = { held, refusal }),
  });
  return { rig, hold };
}

const settled = () => new Promise((resolve) => setImmediate(resolve));

async function answer(rig) {
  rig.answers.at(-1).resolve();
  await settled();
}

test("a press is sent at once and renewed while it is held", async () => {
  const { rig, hold } = bench();
  hold.press("key q", LEFT);
  assert.equal(rig.sent.length, 1);
  for (let renewals = 1; renewals <= 3; renewals += 1) {
    await answer(rig);
    mock.timers.tick(RENEW_MS);
    assert.equal(rig.sent.length, 1 + renewals);
  }
});

test("letting go says stop with a higher number than everything before, and sends nothing more", async () => {
  const { rig, hold } = bench();
  hold.press("key q", LEFT);
  await answer(rig);
  hold.release("key q");
  mock.timers.tick(10 * RENEW_MS);
  assert.deepEqual(rig.last, [{ ...LEFT, rate_deg_s: 0, number: 2 }]);
  assert.equal(rig.sent.length, 1);
  assert.equal(rig.told.held, null);
});

test("a late answer, or a late refusal, of a jog that is over changes nothing", async () => {
  for (const how of ["resolve", "reject"]) {
    const { rig, hold } = bench();
    hold.press("key q", LEFT);
    hold.release("key q");
    hold.press("key e", { ...LEFT, rate_deg_s: -30 });
    rig.answers[0][how](new Error("late"));
    await settled();
    assert.ok(hold.isHeldBy("key e"));
    assert.equal(rig.told.refusal, "");
  }
});

test("what waits in the network when the hand is taken away is given up", () => {
  const { rig, hold } = bench();
  hold.press("pad", LEFT);
  hold.stop("Stopped.");
  assert.ok(rig.answers[0].signal.aborted);
  assert.deepEqual(rig.told, { held: null, refusal: "Stopped." });
});

test("while an answer is missing nothing is sent behind it", () => {
  const { rig, hold } = bench();
  hold.press("pad", LEFT);
  mock.timers.tick(5 * RENEW_MS);
  assert.equal(rig.sent.length, 1);
});

test("a refusal ends the jog and is told in its own words", async () => {
  const { rig, hold } = bench();
  hold.press("pad", LEFT);
  rig.answers[0].reject(new Error("this swing leads out of the workspace"));
  await settled();
  assert.equal(rig.told.refusal, "this swing leads out of the workspace");
  mock.timers.tick(5 * RENEW_MS);
  assert.equal(rig.sent.length, 1);
});

test("an obstacle that comes up while it is held ends the jog at the next renewal", async () => {
  const { rig, hold } = bench();
  hold.press("pad", LEFT);
  await answer(rig);
  rig.obstacle = "A run is on.";
  mock.timers.tick(RENEW_MS);
  assert.equal(rig.last.length, 1);
  assert.equal(rig.told.refusal, "A run is on.");
});

test("with an obstacle in the way nothing is sent at all", () => {
  const { rig, hold } = bench();
  rig.obstacle = "Arm the rig to jog.";
  hold.press("pad", LEFT);
  assert.deepEqual([rig.sent, rig.last], [[], []]);
});

test("the newest hand counts, and the one before it ends nothing any more", async () => {
  const { rig, hold } = bench();
  hold.press("key q", LEFT);
  hold.press("key d", { ...LEFT, pivot: -1, rate_deg_s: -30 });
  hold.release("key q");
  assert.ok(hold.isHeldBy("key d"));
  hold.release("key d");
  assert.equal(rig.last.at(-1).pivot, -1);
});

test("another end or another way round is sent at once, another rate with the next renewal", async () => {
  const { rig, hold } = bench();
  hold.press("gamepad", LEFT);
  await answer(rig);
  hold.change("gamepad", { ...LEFT, rate_deg_s: 40 });
  assert.equal(rig.sent.length, 1);
  hold.change("gamepad", { ...LEFT, rate_deg_s: -40 });
  assert.equal(rig.sent.at(-1).rate_deg_s, -40);
  hold.change("somebody else", LEFT);
  assert.equal(rig.sent.length, 2);
});
