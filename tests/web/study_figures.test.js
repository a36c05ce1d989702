import assert from "node:assert/strict";
import test from "node:test";

import { isGrid, layoutOf, panelsOf, setAt, valuesAlong } from "../../web/studies/projection.js";
import { colourAt, GRADIENT, inkAt, scaleOf } from "../../web/studies/scale.js";

const NOTHING_CHOSEN = { across: null, down: null, fixed: {} };

/** A study of every combination of these values. */
function gridOf(axes) {
  const combine = ([first, ...rest]) =>
    first === undefined ? [{}] : first.values.flatMap((value) => combine(rest).map((others) => ({ [first.name]: value, ...others })));
  return { axes, sets: combine(axes).map((values) => ({ values })) };
}

const TILT = { name: "tilt", values: [30, 20, 25] };
const LAW = { name: "law", values: ["wait", "path_step"] };
const SEED = { name: "seed", values: [1] };

test("numbers grow along an axis, words keep their order", () => {
  const { sets } = gridOf([TILT, LAW]);
  assert.deepEqual(valuesAlong(sets, TILT), [20, 25, 30]);
  assert.deepEqual(valuesAlong([...sets].reverse(), LAW), ["wait", "path_step"]);
});

test("a number that varies goes across, whatever stands first", () => {
  const { across, down, panel } = layoutOf(gridOf([SEED, LAW, TILT]), NOTHING_CHOSEN);
  assert.deepEqual([across.name, down.name, panel], ["tilt", "law", null]);
});

test("a choice of somebody holds, but no axis is both across and down", () => {
  const study = gridOf([TILT, LAW]);
  assert.equal(layoutOf(study, { ...NOTHING_CHOSEN, across: "law" }).across.name, "law");
  const { across, down } = layoutOf(study, { ...NOTHING_CHOSEN, across: "tilt", down: "tilt" });
  assert.deepEqual([across.name, down.name], ["tilt", "law"]);
});

test("further axes become panels or are held at a value, and no set is shown twice", () => {
  const step = { name: "step", values: [0.1, 0.2] };
  const many = { name: "many", values: Array.from({ length: 12 }, (_, index) => index) };
  const study = gridOf([TILT, LAW, step, many]);
  const layout = layoutOf(study, { ...NOTHING_CHOSEN, across: "tilt", down: "law", fixed: { many: 5 } });
  assert.equal(layout.panel.name, "step");
  assert.deepEqual(layout.chosen.map(({ axis, value }) => [axis.name, value]), [["many", 5]]);
  const panels = panelsOf(study.sets, layout);
  assert.deepEqual(panels.map(({ value }) => value), [0.1, 0.2]);
  assert.equal(new Set(panels.flatMap(({ sets }) => sets)).size, 2 * 6);
});

test("a study without sets yet has nothing to lay out, and does not fall over", () => {
  const layout = layoutOf({ axes: [TILT], sets: [] }, NOTHING_CHOSEN);
  assert.equal(layout.across, null);
  assert.equal(isGrid([], layout), false);
});

test("combinations are a grid, scattered values are none", () => {
  const study = gridOf([TILT, LAW]);
  const layout = layoutOf(study, NOTHING_CHOSEN);
  assert.ok(isGrid(study.sets, layout));
  assert.deepEqual(setAt(study.sets, layout.across, 25, layout.down, "wait").values, { tilt: 25, law: "wait" });
  assert.equal(setAt(study.sets, layout.across, 26, layout.down, "wait"), undefined);
  const points = Array.from({ length: 30 }, (_, index) => ({ values: { a: index, b: (index * 7) % 30 } }));
  const scattered = { axes: [{ name: "a", values: points.map(({ values }) => values.a) }, { name: "b", values: points.map(({ values }) => values.b) }], sets: points };
  assert.equal(isGrid(points, layoutOf(scattered, NOTHING_CHOSEN)), false);
});

test("a scale goes from the least to the largest value that is known", () => {
  const { low, high, share } = scaleOf([3, null, NaN, 1, 5]);
  assert.deepEqual([low, high, share(1), share(5), share(3)], [1, 5, 0, 1, 0.5]);
  assert.equal(scaleOf([4, 4]).share(4), 0.5);
  assert.equal(scaleOf([null]), null);
});

const channels = (colour) => colour.match(/\d+/g).map(Number);

function luminance(colour) {
  const [red, green, blue] = colour.map((channel) => (channel <= 10 ? channel / 3294.6 : ((channel / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

test("more is always lighter, so that the scale is read without seeing its colours", () => {
  const shades = Array.from({ length: 101 }, (_, index) => luminance(channels(colourAt(index / 100))));
  shades.slice(1).forEach((shade, index) => assert.ok(shade > shades[index] - 1e-4, `at ${index} %`));
  assert.equal(GRADIENT.length > 5, true);
});

test("what is written on a colour of the scale has a contrast of 4.5 or more", () => {
  for (let share = 0; share <= 1; share += 0.005) {
    const [ground, ink] = [luminance(channels(colourAt(share))), inkAt(share) === "#ffffff" ? 1 : 0];
    const contrast = (Math.max(ground, ink) + 0.05) / (Math.min(ground, ink) + 0.05);
    assert.ok(contrast >= 4.5, `${contrast.toFixed(2)} at ${share.toFixed(3)}`);
  }
});

test("beyond its ends the scale keeps its last colours", () => {
  assert.equal(colourAt(-1), colourAt(0));
  assert.equal(colourAt(2), colourAt(1));
});
