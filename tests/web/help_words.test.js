import assert from "node:assert/strict";
import test from "node:test";
import { CONTROLLERS } from "../../web/help/controllers.js";
import { arc, head, polar, sampled } from "../../web/help/figures/geometry.js";
import { GAIT, RUN } from "../../web/help/gait.js";
import { METRICS } from "../../web/help/metrics.js";
import { pieces } from "../../web/help/notation.js";

const entries = [GAIT, RUN, METRICS, ...Object.values(CONTROLLERS)].flatMap((part) => Object.entries(part));

test("a help is a few whole sentences", () => {
  for (const [name, { words }] of entries) {
    assert.ok(words.length >= 1 && words.length <= 2, name);
    for (const text of words) assert.match(text, /^\p{Lu}.*[.”]$/u, name);
    assert.ok(words.join(" ").length < 420, name);
  }
});

test("letters after an underscore are lowered, and nothing is lost", () => {
  assert.deepEqual(pieces("θ_s"), [{ text: "θ", lowered: false }, { text: "s", lowered: true }]);
  assert.deepEqual(pieces("|c − x_d|").map(({ text }) => text), ["|c − x", "d", "|"]);
  assert.deepEqual(pieces("a_ b"), [{ text: "a_ b", lowered: false }]);
});

test("angles go to the left, as on paper, though the picture's y goes down", () => {
  const [x, y] = polar([0, 0], 10, 90);
  assert.ok(Math.abs(x) < 1e-9 && Math.abs(y + 10) < 1e-9);
  assert.match(arc([0, 0], 10, 0, 90), /^M10 0A10 10 0 0 0 0 -10$/);
});

test("the head of an arrow ends at its point", () => {
  assert.match(head([20, 0], [0, 0]), /^M20 0L/);
  assert.equal(sampled((share) => [share, 0], 4).length, 5);
});
