/** Sets of a study seen along one or two of its axes. Pure. */

/** Panels beyond this are chosen one by one. */
const MOST_PANELS = 9;
/** More columns than this cannot be read as cells. */
const MOST_CELLS = 40;
/** A design counts as a grid when so many of its cells are in use. */
const FILLED = 0.5;

export const isNumeric = (axis) => axis.values.length > 0 && axis.values.every((value) => typeof value === "number");

/** Values that the sets really have, in the axis's order or growing. */
export function valuesAlong(sets, axis) {
  const there = [...new Set(sets.map(({ values }) => values[axis.name]))];
  if (there.every((value) => typeof value === "number")) return there.sort((a, b) => a - b);
  const order = new Map(axis.values.map((value, index) => [value, index]));
  return there.sort((a, b) => (order.get(a) ?? Infinity) - (order.get(b) ?? Infinity));
}

/**
 * Which axis goes where: across, down (and one line each), a panel each; the others are fixed at a value.
 * @param view what somebody has chosen so far: {across, down, fixed: {axis: value}}
 */
export function layoutOf(study, view) {
  const axes = study.axes.map((axis) => ({ ...axis, values: valuesAlong(study.sets, axis) })).filter(({ values }) => values.length > 0);
  const byName = (name) => axes.find((axis) => axis.name === name);
  const varied = [...axes].sort((a, b) => Number(b.values.length > 1) - Number(a.values.length > 1));
  const numbersFirst = [...varied].sort((a, b) => Number(isNumeric(b) && b.values.length > 1) - Number(isNumeric(a) && a.values.length > 1));
  const [first, second] = study.surface?.axes ?? [];
  const across = byName(view.across) ?? byName(first) ?? numbersFirst[0] ?? null;
  const rest = varied.filter((axis) => axis !== across);
  const down = view.down !== view.across && rest.includes(byName(view.down)) ? byName(view.down) : (rest.find(({ name }) => name === second) ?? rest[0] ?? null);
  const further = rest.filter((axis) => axis !== down && axis.values.length > 1 && !isScattered(study, axis));
  const panel = further.find((axis) => axis.values.length <= MOST_PANELS) ?? null;
  const chosen = further.filter((axis) => axis !== panel).map((axis) => ({ axis, value: chosenValue(axis, view.fixed) }));
  return { axes, across, down, panel, chosen };
}

/** Along a range hardly two sets share a value: they are all shown, wherever they lie on it. */
const isScattered = ({ axes }, { name }) => axes.find((axis) => axis.name === name).values.length === 0;

const chosenValue = (axis, fixed) => (axis.values.includes(fixed[axis.name]) ? fixed[axis.name] : axis.values[0]);

/** @returns [{value, sets}]: what belongs into each panel; one panel without a value where there is no such axis */
export function panelsOf(sets, { panel, chosen }) {
  const shown = sets.filter(({ values }) => chosen.every(({ axis, value }) => values[axis.name] === value));
  if (panel === null) return [{ value: null, sets: shown }];
  return panel.values.map((value) => ({ value, sets: shown.filter(({ values }) => values[panel.name] === value) }));
}

/** Whether the sets lie on a grid of these two axes, or are scattered. */
export function isGrid(sets, { across, down }) {
  if (!across) return false;
  const rows = down?.values.length ?? 1;
  const cells = across.values.length * rows;
  const used = new Set(sets.map(({ values }) => JSON.stringify([values[across.name], down && values[down.name]]))).size;
  return across.values.length <= MOST_CELLS && rows <= MOST_CELLS && used >= FILLED * cells;
}

/** The set at one cell, or undefined. */
export const setAt = (sets, across, column, down, row) =>
  sets.find(({ values }) => values[across.name] === column && (!down || values[down.name] === row));
