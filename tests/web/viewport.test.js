import test from "node:test";
import assert from "node:assert/strict";
import { isZoomed, MOST_ZOOM, panned, placed, showing, WHOLE, zoomedAt } from "../../web/camera/viewport.js";

const BOX = { width: 800, height: 500 };
/** @type {[number, number]} */
const SIZE = [640, 480];
const on = (view, { u, v }) => {
  const { scale, left, top } = placed(view, BOX, SIZE);
  return { x: left + scale * u, y: top + scale * v };
};
const under = (view, { x, y }) => {
  const { scale, left, top } = placed(view, BOX, SIZE);
  return { u: (x - left) / scale, v: (y - top) / scale };
};
const near = (actual, expected) => assert.ok(Math.abs(actual - expected) < 1e-6, `${actual} is not ${expected}`);

test("the whole picture lies in the middle, as large as it goes", () => {
  const { scale, left, top } = placed(WHOLE, BOX, SIZE);
  near(scale, 500 / 480);
  near(top, 0);
  near(left, (800 - 640 * scale) / 2);
});

test("what lies under the pointer stays there when one zooms", () => {
  let view = zoomedAt(WHOLE, 3, { x: 400, y: 250 }, BOX, SIZE);
  for (const [zoom, x, y] of [[4, 300, 200], [9, 500, 320], [5, 420, 260]]) {
    const before = under(view, { x, y });
    view = zoomedAt(view, zoom, { x, y }, BOX, SIZE);
    const after = under(view, { x, y });
    near(after.u, before.u);
    near(after.v, before.v);
  }
});

test("the zoom ends at both ends, and back out is the whole picture", () => {
  assert.equal(zoomedAt(WHOLE, 99, { x: 1, y: 1 }, BOX, SIZE).zoom, MOST_ZOOM);
  const inside = zoomedAt(WHOLE, 3, { x: 100, y: 400 }, BOX, SIZE);
  assert.ok(isZoomed(inside));
  assert.equal(zoomedAt(inside, 0.2, { x: 700, y: 30 }, BOX, SIZE), WHOLE);
});

test("however one pans, no emptiness comes in beside a picture that fills the box", () => {
  let view = zoomedAt(WHOLE, 4, { x: 400, y: 250 }, BOX, SIZE);
  for (const [dx, dy] of [[5000, 0], [0, 5000], [-9000, -9000], [123, -456]]) {
    view = panned(view, dx, dy, BOX, SIZE);
    const [start, end] = [on(view, { u: 0, v: 0 }), on(view, { u: SIZE[0], v: SIZE[1] })];
    assert.ok(start.x <= 1e-6 && start.y <= 1e-6 && end.x >= BOX.width - 1e-6 && end.y >= BOX.height - 1e-6);
  }
});

test("the picture follows the pointer pixel by pixel", () => {
  const view = zoomedAt(WHOLE, 4, { x: 400, y: 250 }, BOX, SIZE);
  const [before, after] = [on(view, { u: 320, v: 240 }), on(panned(view, 17, -9, BOX, SIZE), { u: 320, v: 240 })];
  near(after.x - before.x, 17);
  near(after.y - before.y, -9);
});

test("a place out of sight is brought into it, one in sight moves nothing", () => {
  const view = zoomedAt(WHOLE, 6, { x: 400, y: 250 }, BOX, SIZE);
  const seen = on(showing(view, { u: 30, v: 450 }, BOX, SIZE), { u: 30, v: 450 });
  assert.ok(seen.x >= 0 && seen.x <= BOX.width && seen.y >= 0 && seen.y <= BOX.height);
  const still = showing(view, { u: 320, v: 240 }, BOX, SIZE);
  near(still.u, view.u);
  near(still.v, view.v);
});
