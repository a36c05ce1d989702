import assert from "node:assert/strict";
import test from "node:test";
import { overlap, placeBeside } from "../../web/help/placing.js";

const ROOM = { width: 1440, height: 900, top: 60 };
const SIZE = { width: 300, height: 200 };
const rect = (left, top, width, height) => ({ left, top, right: left + width, bottom: top + height });
const placed = (target, clear = [], room = ROOM) => {
  const { left, top, side } = placeBeside(target, SIZE, room, clear);
  return { side, rect: rect(left, top, SIZE.width, SIZE.height) };
};

test("it stands to the left where there is room, else on the next side that has some", () => {
  assert.equal(placed(rect(1200, 400, 200, 50)).side, "left");
  assert.equal(placed(rect(20, 400, 200, 50)).side, "right");
  assert.equal(placed(rect(20, 100, 1400, 50)).side, "below");
  assert.equal(placed(rect(20, 800, 1400, 50)).side, "above");
});

test("it is always inside the window and under the bar, and over nothing that must stay clear", () => {
  for (let x = 0; x < 1400; x += 100) {
    for (let y = 60; y < 880; y += 60) {
      const [target, clear] = [rect(x, y, 60, 40), rect(1080, 60, 348, 200)];
      const { rect: own, side } = placed(target, [clear]);
      assert.ok(own.left >= 0 && own.right <= 1440 && own.top >= 60 && own.bottom <= 900, `${x}, ${y}`);
      if (side !== "none") assert.ok(!overlap(own, target) && !overlap(own, clear), `${x}, ${y}`);
    }
  }
});

test("where there is no room beside its target it stands over as little of it as can be", () => {
  const phone = { width: 390, height: 844, top: 112 };
  const [picture, buttons] = [rect(16, 195, 358, 270), rect(16, 615, 358, 150)];
  const { rect: own, side } = placed(picture, [buttons], phone);
  assert.equal(side, "none");
  assert.ok(!overlap(own, buttons) && own.bottom <= buttons.top && own.top > 380, JSON.stringify(own));
});

test("even where everything is in the way it stays in the window", () => {
  const { rect: own } = placed(rect(0, 60, 390, 440), [rect(0, 60, 390, 440)], { width: 390, height: 500, top: 60 });
  assert.ok(own.top >= 60 && own.bottom <= 500);
});
