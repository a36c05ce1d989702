import assert from "node:assert/strict";
import test from "node:test";

import { defaultsOf, fieldsOf, parse, rangeOf, show } from "../../web/forms/schema.js";

const GAIN = { title: "Gain", type: "number", default: 3, exclusiveMinimum: 0, maximum: 100, unit: "1/(cm·s)" };
const SCHEMA = {
  $defs: { Letter: { enum: ["S", "M"], type: "string", title: "Letter" } },
  properties: {
    gain: GAIN,
    tilt_deg: { title: "Tilt", type: "number", default: 25, minimum: 5, maximum: 45, unit: "°" },
    look_ahead_s: { title: "Look-ahead", anyOf: [{ type: "number", exclusiveMinimum: 0, maximum: 5 }, { type: "null" }], default: null, unit: "s" },
    letter: { $ref: "#/$defs/Letter", default: "S" },
    aim: { anyOf: [{ enum: ["centre", "end"], type: "string" }, { type: "null" }], default: null },
    passes: { type: "integer", minimum: 1, title: "Passes" },
    closed: { type: "boolean", default: true },
    points_mm: { type: "array", title: "Points" },
    note: { type: "string", title: "Note" },
  },
};
const fields = Object.fromEntries(fieldsOf(SCHEMA).map((each) => [each.name, each]));

test("each property is a field of the kind that suits it", () => {
  const kinds = Object.fromEntries(Object.values(fields).map(({ name, kind }) => [name, kind]));
  assert.deepEqual(kinds, {
    gain: "number", tilt_deg: "number", look_ahead_s: "number", letter: "choice", aim: "choice", passes: "number",
    closed: "switch", points_mm: "points", note: "text",
  });
});

test("no schema, no fields", () => {
  assert.deepEqual(fieldsOf(null), []);
  assert.deepEqual(defaultsOf({}), {});
});

test("defaults are those that the schema names, null among them", () => {
  assert.deepEqual(defaultsOf(SCHEMA), { gain: 3, tilt_deg: 25, look_ahead_s: null, letter: "S", aim: null, closed: true });
});

test("what may be left open has none as its first choice", () => {
  assert.deepEqual(fields.aim.choices, [null, "centre", "end"]);
  assert.deepEqual(fields.letter.choices, ["S", "M"]);
  assert.equal(show(null, fields.aim), "none");
});

test("a range is said with its unit and with which ends belong to it", () => {
  assert.equal(rangeOf(fields.tilt_deg), "5 to 45°");
  assert.equal(rangeOf(fields.gain), "above 0, at most 100 1/(cm·s)");
  assert.equal(rangeOf({ above: 0, below: 360, unit: "deg/s" }), "above 0, below 360 °/s");
  assert.equal(rangeOf(fields.passes), "1 or more");
  assert.equal(rangeOf(fields.note), "");
});

test("a number may be typed with a comma and with a true minus", () => {
  assert.deepEqual(parse(" 12,5 ", fields.tilt_deg), { value: 12.5 });
  assert.deepEqual(parse("−4", { kind: "number", title: "x" }), { value: -4 });
});

test("the ends of a range are taken or refused as the schema says", () => {
  for (const [text, field, isFine] of [
    ["5", "tilt_deg", true], ["45", "tilt_deg", true], ["4.99", "tilt_deg", false], ["45.01", "tilt_deg", false],
    ["0", "gain", false], ["0.001", "gain", true], ["100", "gain", true], ["100.1", "gain", false],
  ]) {
    assert.equal("value" in parse(text, fields[field]), isFine, `${field} = ${text}`);
  }
});

test("a refusal names the field, what came, and what is allowed with the unit", () => {
  assert.equal(parse("90", fields.tilt_deg).error, "Tilt: 90 is out of range; allowed: 5 to 45°.");
  assert.equal(parse("steep", fields.tilt_deg).error, "Tilt: “steep” is not a number; allowed: 5 to 45°.");
  assert.equal(parse("1.5", fields.passes).error, "Passes: 1.5 is not a whole number; allowed: 1 or more.");
});

test("no text ever becomes a number that is not finite", () => {
  for (const text of ["", "NaN", "Infinity", "-Infinity", "1e999", "1 2", "--1"]) {
    assert.ok("error" in parse(text, { kind: "number", title: "x" }), text);
  }
});

test("only what is optional may be left empty", () => {
  assert.deepEqual(parse("  ", fields.look_ahead_s), { value: null });
  assert.ok("error" in parse("", fields.gain));
});

test("points are one a line, and the wrong line is named", () => {
  assert.deepEqual(parse("0, 0\n\n10 -20\n3;4", fields.points_mm), { value: [[0, 0], [10, -20], [3, 4]] });
  assert.match(parse("0, 0\n1, 2, 3", fields.points_mm).error, /^Line 2, “1, 2, 3”/);
  assert.match(parse("a, b", fields.points_mm).error, /^Line 1/);
});

test("what is shown is what is read back", () => {
  for (const [value, field] of [[0.1, "gain"], [25, "tilt_deg"], [[[1, 2], [3.5, -4]], "points_mm"], [null, "look_ahead_s"]]) {
    assert.deepEqual(parse(show(value, fields[field]), fields[field]), { value });
  }
});
