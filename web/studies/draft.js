/** A definition as a form holds it (texts in rows), and back. What the form has no field for is kept as it is. Pure. */

export const DESIGNS = [
  ["grid", "Grid: every combination"],
  ["list", "List: the first values together, the second ones together, …"],
  ["latin", "Latin hypercube: sets spread evenly"],
  ["tune", "Auto-tune: find the best"],
];

export const RANGED = ["latin", "tune"];

const OMITTED = undefined;

/** @returns {import("../types").Draft} each axis {of, how: "values" | "range", values, from, to, step}; numbers as typed */
export function draftOf(definition) {
  const { axes = [], sets = [], ...rest } = definition;
  const rows = rest.design === "list" ? columnsOf(sets) : axes.map(rowOf);
  return { rest, axes: rows };
}

const text = (value) => (value === null || value === undefined ? "" : String(value));

function rowOf({ of, values, from, to, step }) {
  const given = Array.isArray(values) && values.length > 0;
  return { of, how: given ? "values" : "range", values: given ? values : [], from: text(from), to: text(to), step: text(step) };
}

function columnsOf(sets) {
  const names = [...new Set(sets.flatMap((set) => Object.keys(set)))];
  return names.map((of) => ({ of, how: "values", values: sets.map((set) => set[of]), from: "", to: "", step: "" }));
}

/** What is sent: as JSON has it, with a text that is no number left as a text, so that the server says what is wrong. */
export function definitionOf({ rest, axes }) {
  if (rest.design === "list") return { ...rest, sets: setsOf(axes) };
  return { ...rest, axes: axes.map((axis) => axisOf(axis)) };
}

function axisOf({ of, how, values, from, to, step }) {
  if (how === "values") return { of, values };
  return dropEmpty({ of, from: numberOf(from), to: numberOf(to), step: numberOf(step) });
}

function setsOf(axes) {
  const count = Math.max(0, ...axes.map(({ values }) => values.length));
  return Array.from({ length: count }, (_, index) => Object.fromEntries(axes.filter(({ values }) => index < values.length).map(({ of, values }) => [of, values[index]])));
}

const dropEmpty = (fields) => Object.fromEntries(Object.entries(fields).filter(([, value]) => value !== OMITTED));

/** "12,5" and "12.5" are 12.5; nothing is left out; anything else stays the text that it is. */
export function numberOf(typed) {
  const trimmed = text(typed).trim().replace("−", "-");
  if (trimmed === "") return OMITTED;
  const value = Number(trimmed.replace(",", "."));
  return Number.isFinite(value) ? value : trimmed;
}

/** "20, 25, 30" and "20 25 30": the decimal sign in a list is the point. */
export const valuesOf = (typed) => typed.split(/[\s,;]+/).map(numberOf).filter((value) => value !== OMITTED);

export const textOfValues = (values) => values.map(String).join(", ");

/** Sets one field of the definition's fixed part by its path, such as ["stop", "hours"]; undefined takes it out. */
export function withField(rest, path, value) {
  const [name, ...deeper] = path;
  const next = deeper.length > 0 ? withField(rest?.[name], deeper, value) : value;
  return dropEmpty({ ...rest, [name]: next });
}

export const fieldAt = (rest, path) => path.reduce((value, name) => value?.[name], rest);
