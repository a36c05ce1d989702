import assert from "node:assert/strict";
import test from "node:test";

import { dismiss, get, say, set } from "../../web/store.js";

test("a change leaves the rest as it is, and the state before untouched", () => {
  const before = get();
  set({ passes: 3 });
  assert.equal(get().passes, 3);
  assert.notEqual(get(), before);
  assert.equal(before.passes, 1);
  assert.equal(get().connection, before.connection);
});

test("the same words are shown once, and no more than three messages", () => {
  for (const words of ["a", "a", "b", "c", "d"]) say(words);
  assert.deepEqual(get().messages.map(({ text }) => text), ["b", "c", "d"]);
});

test("a dismissed message goes alone, and may come again", () => {
  dismiss(get().messages[1].id);
  assert.deepEqual(get().messages.map(({ text }) => text), ["b", "d"]);
  say("c");
  assert.equal(get().messages.at(-1).text, "c");
  assert.equal(new Set(get().messages.map(({ id }) => id)).size, 3);
});
