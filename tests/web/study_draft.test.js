import assert from "node:assert/strict";
import test from "node:test";

import { definitionOf, draftOf, fieldAt, numberOf, textOfValues, valuesOf, withField } from "../../web/studies/draft.js";
import { axisTitle, metricOf, metricTitle, progressWords, roughly, setText, valueText, withInterval } from "../../web/studies/words.js";

const DEFINITION = {
  name: "tilt", on: "batch", design: "grid", repeats: 3, a_field_of_tomorrow: { kept: true },
  axes: [{ of: "gait.tilt_deg", values: [20, 25] }, { of: "gait.sweep_deg", from: 10, to: 50, step: 5 }],
};

test("a definition that goes through the form comes out as it went in", () => {
  for (const definition of [
    DEFINITION,
    { ...DEFINITION, axes: [] },
    { name: "list", design: "list", sets: [{ "gait.tilt_deg": 20, controller: "geometric" }, { "gait.tilt_deg": 25, controller: "gradient" }] },
  ]) {
    assert.deepEqual(definitionOf(draftOf(definition)), definition);
  }
});

test("numbers may be typed with a comma; what is none is sent as it is, for the server to refuse in words", () => {
  assert.deepEqual(["12,5", "−3", " 7 ", "", "wide", "1e999"].map(numberOf), [12.5, -3, 7, undefined, "wide", "1e999"]);
});

test("a list of values is split at commas, spaces and semicolons", () => {
  assert.deepEqual(valuesOf("20, 25 30;x"), [20, 25, 30, "x"]);
  assert.equal(textOfValues([20, "x"]), "20, x");
});

test("a field is set by its path, and taken out by nothing", () => {
  const rest = { stop: { hours: 2, runs: 5 } };
  assert.deepEqual(withField(rest, ["stop", "hours"], 3), { stop: { hours: 3, runs: 5 } });
  assert.deepEqual(withField(rest, ["stop", "hours"], undefined), { stop: { runs: 5 } });
  assert.deepEqual(withField({}, ["plant", "name"], "slip"), { plant: { name: "slip" } });
  assert.equal(rest.stop.hours, 2);
  assert.equal(fieldAt(rest, ["stop", "hours"]), 2);
  assert.equal(fieldAt(rest, ["nothing", "there"]), undefined);
});

test("an estimate is told as exactly as it can be", () => {
  assert.deepEqual([0, 20, 720, 19_200, 183_600].map(roughly), ["1 s", "20 s", "12 min", "5 h 20 min", "2 days 3 h"]);
  assert.equal(roughly(NaN), "–");
});

test("a rounded part of a time never fills the next larger one", () => {
  for (let seconds = 100; seconds < 4 * 86_400; seconds += 59) {
    assert.doesNotMatch(roughly(seconds), /h 60 min| 24 h/, `${seconds} s`);
  }
});

test("progress tells of failures and of the time left only where there are any", () => {
  const study = { done: 412, total: 630, failed: 0, state: "stopped", seconds_left: 80 };
  assert.equal(progressWords(study), "412 of 630 runs");
  assert.equal(progressWords({ ...study, failed: 3, state: "running" }), "412 of 630 runs, 3 failed, 1:20 min left");
  assert.equal(progressWords({ ...study, total: 1, done: 0, state: "running", seconds_left: null }), "0 of 1 run");
});

test("a mean has half its interval behind it where one is known", () => {
  assert.equal(withInterval({ mean: 0.2134, low: 0.2014, high: 0.2254 }, 3), "0.213 ± 0.012");
  assert.equal(withInterval({ mean: 0.2134, low: null, high: null }, 3), "0.213");
  assert.equal(withInterval({ mean: null }, 3), "–");
});

test("axes and values have their units", () => {
  const tilt = { name: "t", title: "Tilt", unit: "deg" };
  const law = { name: "l", title: "Time law" };
  assert.equal(axisTitle(tilt), "Tilt in °");
  assert.equal(axisTitle(law), "Time law");
  assert.equal(setText({ t: 25, l: "path_step" }, [tilt, law]), "tilt 25°, time law path step");
  assert.deepEqual([-0.1, null, [1]].map(valueText), ["−0.1", "–", "[1]"]);
});

test("a metric that the page does not know is still named", () => {
  assert.equal(metricTitle(metricOf("normalized_mean_error")), "ME in robot lengths");
  assert.equal(metricTitle(metricOf("end_error_mm")), "end error mm");
});
