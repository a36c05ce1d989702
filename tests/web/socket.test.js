import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { keepOpen } from "../../web/live/socket.js";

/** What a browser's WebSocket does, by hand. */
class Wire {
  static OPEN = 1;
  static all = [];

  constructor(url) {
    this.url = url;
    this.readyState = 0;
    this.sent = [];
    Wire.all.push(this);
  }

  open() {
    this.readyState = 1;
    this.onopen?.();
  }

  hear(data) {
    this.onmessage?.({ data });
  }

  breakOff(event = { code: 1006, reason: "" }) {
    this.readyState = 3;
    this.onclose?.(event);
  }

  send(text) {
    this.sent.push(text);
  }

  close() {
    this.closed = true;
  }
}

const define = (name, value) => Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });

const newest = () => Wire.all.at(-1);

/** A page on a computer of the lab, and what it heard. */
function visit(t) {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  t.mock.method(Math, "random", () => 0.5);
  const heard = { opened: 0, data: [], causes: [], delays: [] };
  const socket = keepOpen("/api/v1/telemetry", {
    open: () => void (heard.opened += 1),
    message: (data, send) => void heard.data.push([data, send]),
    lost(cause, retryAt) {
      heard.causes.push(cause);
      heard.delays.push(retryAt - performance.now());
    },
  });
  return { socket, heard, wait: (ms) => t.mock.timers.tick(ms) };
}

beforeEach(() => {
  Wire.all = [];
  define("WebSocket", Wire);
  define("location", { protocol: "http:", host: "rig.lab:8000" });
  define("navigator", { onLine: true });
});

test("it opens at the page's own host", (t) => {
  visit(t);
  assert.equal(newest().url, "ws://rig.lab:8000/api/v1/telemetry");
});

test("where the page came encrypted, so does the line", (t) => {
  define("location", { protocol: "https:", host: "rig.lab" });
  visit(t);
  assert.equal(newest().url, "wss://rig.lab/api/v1/telemetry");
});

test("each try waits longer than the one before, but never longer than some seconds", (t) => {
  const { heard, wait } = visit(t);
  for (let attempt = 0; attempt < 12; attempt += 1) {
    newest().breakOff();
    wait(20_000);
  }
  assert.equal(Wire.all.length, 13);
  heard.delays.slice(1).forEach((delay, index) => assert.ok(delay >= heard.delays[index] - 1, String(heard.delays)));
  assert.ok(heard.delays[0] < 1000 && heard.delays.at(-1) <= 10_000);
});

test("after a message the next try comes soon again", (t) => {
  const { heard, wait } = visit(t);
  for (let attempt = 0; attempt < 8; attempt += 1) {
    newest().breakOff();
    wait(20_000);
  }
  newest().open();
  newest().hear("tick");
  newest().breakOff();
  assert.ok(heard.delays.at(-1) < 1000, String(heard.delays));
});

test("it says why it was lost, in words", (t) => {
  const { heard, wait } = visit(t);
  for (const event of [{ code: 1006, reason: "" }, { code: 1012, reason: "" }, { code: 4404, reason: "no such run" }]) {
    newest().breakOff(event);
    wait(20_000);
  }
  define("navigator", { onLine: false });
  newest().breakOff();
  assert.deepEqual(heard.causes, [
    "the server does not answer", "the server is shutting down", "no such run", "this device is offline",
  ]);
});

test("a line that is let go comes back by itself, and its late words count no more", (t) => {
  const { socket, heard, wait } = visit(t);
  const old = newest();
  old.open();
  socket.abandon("no telemetry for 2.0 s");
  assert.deepEqual(heard.causes, ["no telemetry for 2.0 s"]);
  assert.ok(old.closed);
  old.hear("late");
  old.breakOff();
  assert.equal(heard.data.length, 0);
  assert.equal(heard.causes.length, 1);
  wait(20_000);
  assert.notEqual(newest(), old);
});

test("somebody may try at once, and only one line is ever open", (t) => {
  const { socket, wait } = visit(t);
  newest().breakOff();
  socket.retry();
  assert.equal(Wire.all.length, 2);
  socket.retry();
  wait(20_000);
  assert.equal(Wire.all.length, 2);
});

test("a closed line stays closed", (t) => {
  const { socket, wait, heard } = visit(t);
  newest().open();
  socket.close();
  newest().breakOff();
  socket.retry();
  wait(60_000);
  assert.equal(Wire.all.length, 1);
  assert.equal(heard.causes.length, 0);
});

test("what the page says by itself goes out while the line is open, and is lost otherwise", (t) => {
  const { socket } = visit(t);
  const wire = newest();
  socket.send("too early");
  wire.open();
  socket.send("heartbeat");
  wire.breakOff();
  socket.send("too late");
  assert.deepEqual(wire.sent, ["heartbeat"]);
});

test("an answer goes out by the line on which the question came, while that is open", (t) => {
  const { heard } = visit(t);
  const wire = newest();
  wire.open();
  wire.hear("picture");
  const [, send] = heard.data[0];
  send("ok");
  wire.readyState = 3;
  send("ok");
  assert.deepEqual(wire.sent, ["ok"]);
});
