import test from "node:test";
import assert from "node:assert/strict";
import { AT_FIRST, LAYERS, toggled, understood } from "../../web/scene/layers.js";
import { marks } from "../../web/scene/scale.js";

test("a layer goes and comes back, and the order stays", () => {
  const without = toggled(AT_FIRST, "coils");
  assert.deepEqual(without, ["field", "reference", "trail"]);
  assert.deepEqual(toggled(without, "coils"), AT_FIRST);
});

test("the camera is off at first, since it costs the network most", () => {
  assert.ok(LAYERS.some(([name]) => name === "camera"));
  assert.ok(!AT_FIRST.includes("camera"));
});

test("what was remembered counts as far as it makes sense", () => {
  assert.deepEqual(understood(null), AT_FIRST);
  assert.deepEqual(understood("garbage"), AT_FIRST);
  assert.deepEqual(understood('{"field": 1}'), AT_FIRST);
  assert.deepEqual(understood("[]"), []);
  assert.deepEqual(understood('["trail", "moon", "field"]'), ["field", "trail"]);
});

test("the field's scale has its begin, its middle and its end", () => {
  assert.deepEqual(marks(12), ["0", "6", "12"]);
  assert.deepEqual(marks(15), ["0", "7.5", "15"]);
});
