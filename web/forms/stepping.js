/** One step up or down from a number in a form: sensible in size, never out of range. Pure. */

/** @typedef {import("./schema.js").Form} Form */

/** A field whose schema names no step moves by about this share of its value. */
const SHARE = 0.1;
const FAR = 10;

/**
 * How much one press of an arrow key changes.
 * @param {Form} form
 * @param {number} value
 */
export function stepOf({ step, integer }, value) {
  if (step) return step;
  if (integer) return 1;
  const size = Math.abs(value) * SHARE;
  return size > 0 ? 10 ** Math.floor(Math.log10(size * 1.001)) : SHARE;
}

/**
 * The value after `count` steps (negative: down), on a multiple of the step, held inside the range.
 * @param {Form} form
 * @param {number | null | undefined} value null: a field that was left open begins at its lowest
 * @param {number} count
 */
export function stepped(form, value, count) {
  const from = value ?? form.initial ?? form.low ?? form.above ?? 0;
  const step = stepOf(form, from);
  const place = from / step;
  // A value between two multiples goes to the next of them first.
  const base = count > 0 ? Math.floor(place + 1e-9) : Math.ceil(place - 1e-9);
  return inside(form, rounded((base + count) * step, step), step);
}

/** @param {KeyboardEvent} event @returns {number} how many steps a key means, 0 for other keys */
export function stepsOfKey({ key, shiftKey, ctrlKey, altKey, metaKey }) {
  if (ctrlKey || altKey || metaKey) return 0;
  const direction = { ArrowUp: 1, ArrowDown: -1, PageUp: FAR, PageDown: -FAR }[key] ?? 0;
  return direction * (shiftKey && Math.abs(direction) === 1 ? FAR : 1);
}

/** An open end is stepped up to, and kept away from by a step, or by less where a step is too much. @param {Form} form @param {number} value @param {number} step */
function inside({ low, high, above, below }, value, step) {
  const floor = low ?? (above === undefined ? -Infinity : above + small(step, above, below ?? high));
  const ceiling = high ?? (below === undefined ? Infinity : below - small(step, above ?? low, below));
  return Math.min(ceiling, Math.max(floor, value));
}

const small = (step, from = -Infinity, to = Infinity) => Math.min(step, (to - from) / 100);

/** Without the tail of binary arithmetic: 0.1 + 0.2 is 0.3. */
function rounded(value, step) {
  const digits = Math.max(0, Math.ceil(-Math.log10(step)) + 2);
  return Number(value.toFixed(Math.min(12, digits)));
}
