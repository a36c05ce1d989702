/** Reads a JSON schema as a list of form fields, and a typed text as a value of such a field. Pure. */
import { unitSign } from "../units.js";

/**
 * @typedef {Object} Form one field of a form
 * @property {string} name
 * @property {string} title
 * @property {string} [description]
 * @property {string} unit
 * @property {string} kind "number", "text", "choice", "switch" or "points"
 * @property {boolean} [integer]
 * @property {boolean} [optional] may be left empty
 * @property {any} [initial] its default
 * @property {any[]} [choices]
 * @property {number} [low] at least this
 * @property {number} [high] at most this
 * @property {number} [above] more than this
 * @property {number} [below] less than this
 * @property {number} [step] a sensible change, in its unit
 * @property {[number, number]} [usual] what a slider spans
 * @property {boolean} [live] may change while a run goes on
 */

/**
 * @param {any} schema
 * @returns {Form[]}
 */
export function fieldsOf(schema) {
  return Object.entries(schema?.properties ?? {}).map(([name, property]) => field(name, resolved(property, schema)));
}

export function defaultsOf(schema) {
  const known = fieldsOf(schema).filter(({ initial }) => initial !== undefined);
  return Object.fromEntries(known.map(({ name, initial }) => [name, initial]));
}

function resolved(property, schema) {
  const reference = property.$ref ?? property.allOf?.[0]?.$ref;
  if (reference) return { ...schema.$defs?.[reference.split("/").at(-1)], ...property };
  const variants = property.anyOf ?? property.oneOf;
  if (!variants) return property;
  const first = variants.find((variant) => variant.type !== "null") ?? {};
  return { ...resolved(first, schema), ...property, optional: variants.some((variant) => variant.type === "null") };
}

function field(name, property) {
  return {
    name,
    title: property.title ?? name,
    description: property.description ?? "",
    unit: property.unit ?? "",
    kind: kindOf(property),
    integer: property.type === "integer",
    optional: property.optional ?? false,
    initial: property.default,
    choices: choicesOf(property),
    low: property.minimum, high: property.maximum,
    above: property.exclusiveMinimum, below: property.exclusiveMaximum,
    step: property.step, usual: property.usual, live: property.live ?? false,
  };
}

/** A choice that may be left open has null, "none", as its first one. */
function choicesOf({ enum: several, const: only, optional }) {
  const choices = several ?? (only === undefined ? [] : [only]);
  return optional && choices.length > 0 && !choices.includes(null) ? [null, ...choices] : choices;
}

function kindOf({ type, enum: choices, const: only }) {
  if (choices || only !== undefined) return "choice";
  if (type === "boolean") return "switch";
  if (type === "array") return "points";
  return type === "number" || type === "integer" ? "number" : "text";
}

/**
 * "1 to 350°", "above 0, below 360 °/s": what is allowed, with the unit.
 * @param {Pick<Form, "low" | "high" | "above" | "below" | "unit">} form
 * @returns {string}
 */
export function rangeOf({ low, high, above, below, unit }) {
  if (low !== undefined && high !== undefined) return withUnit(`${low} to ${high}`, unit);
  const floor = low !== undefined ? `${low} or more` : above !== undefined ? `above ${above}` : "";
  const ceiling = high !== undefined ? `at most ${high}` : below !== undefined ? `below ${below}` : "";
  const range = [floor, ceiling].filter(Boolean).join(", ");
  return range && withUnit(range, unit);
}

function withUnit(text, unit) {
  const sign = unitSign(unit);
  return sign === "°" || sign === "" ? `${text}${sign}` : `${text} ${sign}`;
}

/**
 * @param {string} text as it is typed, with a point or a comma
 * @param {Form} form
 * @returns {{value?: any, error?: string}}
 */
export function parse(text, form) {
  const trimmed = text.trim();
  if (trimmed === "" && form.optional) return { value: null };
  if (form.kind === "points") return parsePoints(trimmed);
  if (form.kind !== "number") return { value: text };
  const value = Number(trimmed.replace("−", "-").replace(",", "."));
  if (trimmed === "" || !Number.isFinite(value)) return { error: refusal(form, `“${trimmed}” is not a number`) };
  if (form.integer && !Number.isInteger(value)) return { error: refusal(form, `${trimmed} is not a whole number`) };
  return allowed(value, form) ? { value } : { error: refusal(form, `${trimmed} is out of range`) };
}

/** @param {number} value @param {Form} form */
function allowed(value, { low, high, above, below }) {
  const floor = (low === undefined || value >= low) && (above === undefined || value > above);
  const ceiling = (high === undefined || value <= high) && (below === undefined || value < below);
  return floor && ceiling;
}

function refusal(form, what) {
  const range = rangeOf(form);
  return `${form.title}: ${what}${range ? `; allowed: ${range}` : ""}.`;
}

/** One point a line, "x, y". */
function parsePoints(text) {
  const points = [];
  for (const [index, line] of text.split("\n").entries()) {
    const numbers = line.trim().split(/[\s,;]+/).map(Number);
    if (line.trim() === "") continue;
    if (numbers.length !== 2 || !numbers.every(Number.isFinite)) {
      return { error: `Line ${index + 1}, “${line.trim()}”, is not a point: write two numbers in mm, such as 10, -20.` };
    }
    points.push(numbers);
  }
  return { value: points };
}

/**
 * A value as it stands in its field.
 * @param {any} value
 * @param {{kind: string}} form
 */
export function show(value, { kind }) {
  if (kind === "choice") return value === null ? "none" : String(value).replaceAll("_", " ");
  if (value === null || value === undefined) return "";
  if (kind === "points") return value.map((point) => point.join(", ")).join("\n");
  return typeof value === "number" ? String(Number(value.toPrecision(8))) : String(value);
}
