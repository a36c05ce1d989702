import test from "node:test";
import assert from "node:assert/strict";
import { projection, unprojection } from "../../web/camera/projection.js";

const { cos, sin } = Math;

/** Looks down from 300 mm, turned about its axis and tilted, as one row-major rotation. */
function tilted(turn, tilt) {
  const [c, s, d, e] = [cos(turn), sin(turn), cos(tilt), sin(tilt)];
  return [c, s, 0, d * s, -d * c, -e, -e * s, e * c, -d];
}

const MODELS = {
  "a plain camera": { fx: 1000, fy: 1000, cx: 320, cy: 240, distortion: [0, 0, 0, 0, 0], rotation: tilted(0, 0), translation_mm: [0, 0, 300] },
  "a tilted camera": { fx: 980, fy: 1010, cx: 331, cy: 229, distortion: [0, 0, 0, 0, 0], rotation: tilted(0.3, 0.4), translation_mm: [4, -7, 310] },
  "a wide lens": { fx: 520, fy: 515, cx: 318, cy: 244, distortion: [-0.28, 0.09, 0.0012, -0.0008, -0.01], rotation: tilted(-0.1, 0.15), translation_mm: [1, 2, 180] },
  "a lens that bends outwards": { fx: 700, fy: 700, cx: 320, cy: 240, distortion: [0.12, -0.03, -0.002, 0.001, 0.004], rotation: tilted(1.2, -0.2), translation_mm: [0, 0, 250] },
};

for (const [name, model] of Object.entries(MODELS)) {
  test(`${name}: what is seen of a point leads back to it, at any height`, () => {
    const [there, back] = [projection(model), unprojection(model)];
    for (const height of [0, 3, 12]) {
      for (let x = -60; x <= 60; x += 15) {
        for (let y = -60; y <= 60; y += 15) {
          const found = back(...there(x, y, height), height);
          assert.ok(found && Math.hypot(found[0] - x, found[1] - y) < 1e-4, `${x}, ${y} became ${found}`);
        }
      }
    }
  });
}

test("a ray that never meets the plate leads nowhere", () => {
  const level = { ...MODELS["a plain camera"], rotation: [1, 0, 0, 0, 0, -1, 0, 1, 0], translation_mm: [0, 20, 300] };
  assert.equal(unprojection(level)(320, 100), null);
});
