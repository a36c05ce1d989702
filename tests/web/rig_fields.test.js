/** The rig file as forms: its schema as fields, what a draft changes, and what the server is asked for. */
import test from "node:test";
import assert from "node:assert/strict";
import { at, changesOf, entryValue, errorTexts, inWords, matching, nested, sectionsOf, titleAt, valuesOf, withEntry } from "../../web/rig/fields.js";

const number = (title, unit, more = {}) => ({ type: "number", title, description: "", unit, live: false, found: false, ...more });
const SCHEMA = {
  properties: {
    version: { type: "integer", title: "Version", found: true },
    name: { type: "string", title: "Name", description: "", live: true, found: false, default: "The paper's rig" },
    limits: {
      title: "Limits", description: "What it may do.",
      properties: {
        field_mT: number("Field", "mT", { exclusiveMinimum: 0, maximum: 50, default: 15 }),
        current_A: number("Current", "A", { type: "array", items: { type: "number", maximum: 30 }, minItems: 3, maxItems: 3, labels: ["x", "y", "z"], default: [8, 8, 8] }),
      },
    },
    coils: {
      title: "Coils", description: "",
      properties: { x: { title: "x", description: "", properties: { turns: { type: "integer", title: "Turns", description: "", live: false, found: false } } } },
    },
    notifications: {
      title: "Notifications", description: "",
      properties: { on: { type: "array", title: "Tell of", description: "", items: { enum: ["fault", "study"] }, maxItems: 2, labels: ["faults", "studies"], live: true, found: false, default: ["fault"] } },
    },
  },
};
const RIG = { name: "The paper's rig", limits: { field_mT: 15, current_A: [8, 8, 8] }, coils: { x: { turns: 314 } }, notifications: { on: ["fault"] } };
const SECTIONS = sectionsOf(SCHEMA);
const value = (path) => valuesOf(SECTIONS).find((known) => known.path === path);

test("every value has a place in a section, but for those that a calibration writes", () => {
  assert.deepEqual(SECTIONS.map(({ name }) => name), ["general", "limits", "coils", "notifications"]);
  assert.deepEqual(valuesOf(SECTIONS).map(({ path }) => path), ["name", "limits.field_mT", "limits.current_A", "coils.x.turns", "notifications.on"]);
});

test("a list of numbers has a field each, with the unit and its own label", () => {
  const { entries } = value("limits.current_A");
  assert.deepEqual(entries.map(({ form }) => [form.title, form.unit, form.initial]), [["Current x", "A", 8], ["Current y", "A", 8], ["Current z", "A", 8]]);
  assert.deepEqual(withEntry([8, 8, 8], entries[1], 7, value("limits.current_A")), [8, 7, 8]);
  assert.equal(entryValue([8, 7, 6], entries[2]), 6);
  assert.equal(entryValue(null, entries[2]), null);
});

test("a list that may be left out is out once its last number is", () => {
  const whole = value("limits.current_A");
  assert.deepEqual(withEntry(null, whole.entries[0], 5, whole), [5, null, null]);
  assert.equal(withEntry([5, null, null], whole.entries[0], null, whole), null);
});

test("a set has a switch for each of its words, and keeps their order", () => {
  const whole = value("notifications.on");
  assert.deepEqual(whole.entries.map(({ form }) => [form.title, form.kind]), [["faults", "switch"], ["studies", "switch"]]);
  assert.deepEqual(withEntry(["study"], whole.entries[0], true, whole), ["fault", "study"]);
  assert.deepEqual(withEntry(["fault"], whole.entries[0], false, whole), []);
});

test("changes say what a value is and will be, with the unit, and whether it may change at any time", () => {
  const draft = { "limits.field_mT": 12.5, "limits.current_A": [8, 8, 8], name: "Bench 4", "coils.x.turns": 300 };
  assert.deepEqual(changesOf(SECTIONS, draft, RIG), [
    { path: "name", live: true, title: "Name", from: "The paper's rig", to: "Bench 4" },
    { path: "limits.field_mT", live: false, title: "Limits · Field", from: "15 mT", to: "12.5 mT" },
    { path: "coils.x.turns", live: false, title: "Coils · Coils x · Turns", from: "314", to: "300" },
  ]);
});

test("the server is asked for nested values", () => {
  assert.deepEqual(nested({ "limits.field_mT": 12, "limits.current_A": [1, 2, 3], name: "B", "coils.x.turns": null }), {
    limits: { field_mT: 12, current_A: [1, 2, 3] }, name: "B", coils: { x: { turns: null } },
  });
  assert.equal(at(RIG, "coils.x.turns"), 314);
  assert.equal(at(RIG, "coils.w.turns"), undefined);
});

test("what is looked for is found in titles, names and units of all sections", () => {
  const found = (text) => valuesOf(matching(SECTIONS, text)).map(({ path }) => path);
  assert.deepEqual(found("field"), ["limits.field_mT"]);
  assert.deepEqual(found("limits mt"), ["limits.field_mT"]);
  assert.deepEqual(found("no such thing"), []);
  assert.equal(found(" ").length, 5);
});

test("the server's words stand beside the field that they are of", () => {
  assert.deepEqual(errorTexts([{ loc: ["limits", "current_A", 1], message: "must be less than 30" }]), { "rig.limits.current_A.1": "must be less than 30" });
});

test("values read as a person writes them", () => {
  assert.deepEqual([inWords(null), inWords(""), inWords(true), inWords(15, "mT"), inWords(90, "°"), inWords([1, 2], "A"), inWords([], "")],
    ["none", "none", "on", "15 mT", "90°", "1, 2 A", "none"]);
  assert.deepEqual(titleAt(SECTIONS, "limits.field_mT"), { title: "Limits · Field", unit: "mT" });
  assert.deepEqual(titleAt(SECTIONS, "camera.lens"), { title: "camera.lens", unit: "" });
});
