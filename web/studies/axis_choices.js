/** What a study may vary, made from the JSON schemas of controllers, trajectories, gait and plants. Pure. */
import { fieldsOf, rangeOf } from "../forms/schema.js";

const VARIED = ["number", "choice", "switch"];

/**
 * @param {Pick<import("../types").State, "controllers" | "trajectories" | "plants" | "gaitSchema">} known
 * @param rest the definition's fixed part: controller, trajectory, plant, on
 * @returns [{title, axes: [{name, title, unit, kind, choices, initial, range, low, high, integer, description}]}]
 */
export function axisGroups(known, rest) {
  const batch = rest.on !== "rig";
  return [
    { title: "What walks", axes: [choiceAxis("controller", "Controller", known.controllers), ...(batch ? [choiceAxis("plant", "Plant", known.plants)] : [])] },
    { title: "Gait", axes: schemaAxes("gait", known.gaitSchema, rest.gait) },
    partGroup("controller", "Controller", known.controllers, rest.controller),
    partGroup("trajectory", "Trajectory", known.trajectories, rest.trajectory),
    ...(batch ? [partGroup("plant", "Plant", known.plants, rest.plant ?? { name: "slip" })] : []),
  ].filter(({ axes }) => axes.length > 0);
}

export const allAxes = (groups) => groups.flatMap(({ axes }) => axes);

function choiceAxis(name, title, entries) {
  return { name, title, unit: "", kind: "choice", choices: (entries ?? []).map((entry) => entry.name), initial: undefined, range: "", description: "" };
}

function partGroup(part, title, entries, chosen) {
  const entry = (entries ?? []).find(({ name }) => name === chosen?.name);
  return { title: `${title}: ${entry?.title ?? chosen?.name ?? "–"}`, axes: schemaAxes(part, entry?.parameters, chosen?.parameters) };
}

function schemaAxes(part, schema, values) {
  return fieldsOf(schema).filter(({ kind }) => VARIED.includes(kind)).map((form) => ({
    ...form,
    name: `${part}.${form.name}`,
    choices: form.kind === "switch" ? [false, true] : form.choices,
    kind: form.kind === "switch" ? "choice" : form.kind,
    initial: values?.[form.name] ?? form.initial,
    range: rangeOf(form),
  }));
}

/** Three values around the one in use, inside what is allowed: something to begin with. */
export function firstValues({ kind, choices, initial, low = -Infinity, high = Infinity, integer }) {
  if (kind === "choice") return choices.slice(0, 2);
  const middle = typeof initial === "number" ? initial : 1;
  const near = (factor) => Number(Math.min(high, Math.max(low, middle * factor)).toPrecision(2));
  const values = [near(0.8), middle, near(1.2)].map((value) => (integer ? Math.round(value) : value));
  return [...new Set(values)];
}
