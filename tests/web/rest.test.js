import assert from "node:assert/strict";
import test from "node:test";

import { onRefusal, patch, post, Problem, read, remove } from "../../web/live/rest.js";

const answering = (t, body, init) =>
  t.mock.method(globalThis, "fetch", async () => new Response(body === null ? null : JSON.stringify(body), init));

async function refusalOf(promise) {
  const problem = await promise.then(() => assert.fail("was not refused"), (reason) => reason);
  assert.ok(problem instanceof Problem, String(problem));
  return problem;
}

test("an answer is its JSON, and an empty one is nothing", async (t) => {
  answering(t, { runs: [] });
  assert.deepEqual(await read("/runs"), { runs: [] });
  answering(t, null, { status: 204 });
  assert.equal(await remove("/runs/1"), null);
});

test("a refusal carries the server's words, and for each field what is wrong with it", async (t) => {
  const errors = [
    { loc: ["gait", "sweep_deg"], message: "at most 350°" },
    { loc: ["trajectory", "parameters", "points_mm", 3, 0], message: "leaves the workspace" },
  ];
  answering(t, { title: "Wrong value", detail: "The sweep is too large.", errors }, { status: 422 });
  const { message, status, fields } = await refusalOf(patch("/runs/current", {}));
  assert.equal(message, "The sweep is too large.");
  assert.equal(status, 422);
  assert.deepEqual(fields, { "gait.sweep_deg": "at most 350°", "trajectory.points_mm": "leaves the workspace" });
});

test("a refusal that is no JSON is still said in words", async (t) => {
  t.mock.method(globalThis, "fetch", async () => new Response("<h1>Bad gateway</h1>", { status: 502 }));
  const { message, status } = await refusalOf(read("/rig"));
  assert.match(message, /502/);
  assert.equal(status, 502);
});

test("a silent server has no status, and nothing was changed", async (t) => {
  t.mock.method(globalThis, "fetch", async () => {
    throw new TypeError("Failed to fetch");
  });
  const { status, message } = await refusalOf(patch("/rig", {}));
  assert.equal(status, 0);
  assert.match(message, /does not answer/);
});

test("an answer that breaks off is a refusal, not half an answer", async (t) => {
  t.mock.method(globalThis, "fetch", async () => new Response('{"runs": [', { status: 200 }));
  await refusalOf(read("/runs"));
});

test("each request says from which tab it comes", async (t) => {
  const { mock } = answering(t, {});
  for (const ask of [() => read("/rig"), () => post("/arm", {}, { keepalive: true }), () => patch("/rig", {}), () => remove("/runs/1")]) await ask();
  const names = mock.calls.map(({ arguments: [, { headers }] }) => headers["X-Client"]);
  assert.match(names[0], /^[0-9a-f]{32}$/);
  assert.deepEqual(names, Array(4).fill(names[0]));
  assert.equal(mock.calls[1].arguments[1].headers["Content-Type"], "application/json");
});

test("whoever else is concerned hears of a refusal too, and who operates", async (t) => {
  const heard = [];
  onRefusal((problem) => void heard.push(problem));
  answering(t, { title: "Somebody else operates", holder: { id: "a1", name: "Anna" } }, { status: 409 });
  const problem = await refusalOf(post("/arm"));
  assert.deepEqual(heard, [problem]);
  assert.equal(problem.holder.name, "Anna");
});
