import assert from "node:assert/strict";
import test from "node:test";

import { keep, recalled } from "../../web/memory.js";

const use = (storage) => Object.defineProperty(globalThis, "localStorage", { get: storage, configurable: true });

test("what is kept is recalled, and nothing else is touched", () => {
  const kept = new Map([["charts", "of somebody else"]]);
  use(() => ({ getItem: (name) => kept.get(name) ?? null, setItem: (name, text) => kept.set(name, text) }));
  keep("charts", { window_s: 60 });
  assert.deepEqual(recalled("charts"), { window_s: 60 });
  assert.equal(kept.get("charts"), "of somebody else");
  assert.equal(recalled("other"), null);
});

test("a text that nobody can read is as good as none", () => {
  use(() => ({ getItem: () => "{torn" }));
  assert.equal(recalled("charts"), null);
});

test("a browser that keeps nothing is no reason to fail", () => {
  use(() => {
    throw new Error("The operation is insecure.");
  });
  keep("charts", { window_s: 60 });
  assert.equal(recalled("charts"), null);
});
