import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";

import { pivotPoint, projection } from "../../web/camera/projection.js";

/** Written, and held up to date, by OpenCV itself: opencv_camera.py. */
const cameras = JSON.parse(readFileSync(new URL("./opencv_points.json", import.meta.url), "utf8"));

for (const [name, { model, places_mm, points_px }] of Object.entries(cameras)) {
  test(`through a ${name} camera points of the plate fall where OpenCV says`, () => {
    const project = projection(model);
    places_mm.forEach((place, index) => {
      const [u, v] = project(...place);
      const [u0, v0] = points_px[index];
      assert.ok(Math.hypot(u - u0, v - v0) < 1e-6, `${place} mm: ${[u, v]} px, by OpenCV ${[u0, v0]} px`);
    });
  });
}

test("the ends stand half a length from the centre, A ahead of the heading by a quarter turn", () => {
  const near = (point, x, y) => assert.ok(Math.hypot(point[0] - x, point[1] - y) < 1e-9, String(point));
  const pose = { x_mm: 3, y_mm: -2, heading_deg: 0 };
  near(pivotPoint(pose, 1, 10), 3, 3);
  near(pivotPoint(pose, -1, 10), 3, -7);
  near(pivotPoint({ ...pose, heading_deg: 90 }, 1, 10), -2, -2);
});

test("the centre is in the middle of the ends whatever the heading", () => {
  for (let heading_deg = -180; heading_deg < 180; heading_deg += 11) {
    const pose = { x_mm: 1.5, y_mm: 7, heading_deg };
    const [a, b] = [pivotPoint(pose, 1, 8), pivotPoint(pose, -1, 8)];
    assert.ok(Math.abs((a[0] + b[0]) / 2 - 1.5) < 1e-9 && Math.abs((a[1] + b[1]) / 2 - 7) < 1e-9);
    assert.ok(Math.abs(Math.hypot(a[0] - b[0], a[1] - b[1]) - 8) < 1e-9);
  }
});
