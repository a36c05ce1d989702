/** What a walk has found, as titles and numbers with their uncertainty. Pure. */
import { fixed, quantity } from "../units.js";

/** "9.87 ± 0.02 mm" */
export function withSpread(value, spread, unit, digits) {
  if (typeof spread !== "number") return quantity(value, unit, digits);
  return `${fixed(value, digits)} ± ${quantity(spread, unit, digits)}`;
}

/** title, name, unit, digits */
const FIGURES = {
  star: [
    ["Pivot length", "length_mm", "mm", 2], ["Heading offset", "heading_offset_deg", "deg", 2],
    ["Body to pivots", "skew_deg", "deg", 2], ["Play", "backlash_deg", "deg", 1],
  ],
  latency: [["Delay to subtract", "latency_ms", "ms", 1]],
};

/** What was measured: [title, text] pairs. figures: {value, standard_error} by name. */
export function figuresOf(kind, figures) {
  return FIGURES[kind]
    .filter(([, name]) => figures?.[name])
    .map(([title, name, unit, digits]) => [title, withSpread(figures[name].value, figures[name].standard_error, unit, digits)]);
}

/** What the rig file has: numbers by the same names. */
export function numbersOf(kind, values) {
  return FIGURES[kind]
    .filter(([, name]) => typeof values?.[name] === "number")
    .map(([title, name, unit, digits]) => [title, quantity(values[name], unit, digits)]);
}
