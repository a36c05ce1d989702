/** From numbers over time to lines on pixels. A value may be null or NaN (a gap) or undefined (none of this curve's). */

/** @returns {value is number} */
const isNumber = (/** @type {unknown} */ value) => typeof value === "number" && !Number.isNaN(value);

/**
 * Draws values as a line with at most four points a pixel column, whose lowest and highest value are kept: a peak of
 * one tick stays to be seen in an hour.
 *
 * @param {ArrayLike<number>} times
 * @param {ArrayLike<number | null | undefined>} values
 * @param {(time: number) => number} toX pixel
 * @param {(value: number) => number} toY pixel
 * @param {{moveTo: (x: number, y: number) => void, lineTo: (x: number, y: number) => void}} pen
 */
export function traceLine(times, values, toX, toY, pen) {
  let column = NaN;
  let low = 0;
  let high = 0;
  let last = 0;
  let down = false;
  const finish = () => {
    if (low === high) return;
    pen.lineTo(column, toY(low));
    pen.lineTo(column, toY(high));
    pen.lineTo(column, toY(last));
  };
  for (let index = 0; index < times.length; index += 1) {
    const value = values[index];
    if (value === undefined) continue;
    if (!isNumber(value)) {
      if (down) finish();
      down = false;
      continue;
    }
    const x = Math.round(toX(times[index]));
    if (down && x === column) {
      low = Math.min(low, value);
      high = Math.max(high, value);
      last = value;
      continue;
    }
    if (down) {
      finish();
      pen.lineTo(x, toY(value));
    } else {
      pen.moveTo(x, toY(value));
    }
    down = true;
    column = x;
    low = high = last = value;
  }
  if (down) finish();
}

/**
 * Draws values as dots, one a cell of the time: which ones does not change while the time moves on.
 *
 * @param {number} cell_s
 */
export function traceDots(times, values, toX, toY, pen, cell_s) {
  let cell = NaN;
  for (let index = 0; index < times.length; index += 1) {
    const own = Math.floor(times[index] / cell_s);
    if (own === cell || !isNumber(values[index])) continue;
    cell = own;
    const [x, y] = [toX(times[index]), toY(values[index])];
    pen.moveTo(x, y);
    // A line of no length with round ends is a dot.
    pen.lineTo(x, y);
  }
}

/**
 * The lowest and the highest of all values of several columns.
 *
 * @param {ArrayLike<number | null | undefined>[]} columns
 * @returns {[number, number] | null} null: there is none
 */
export function extent(columns) {
  let low = Infinity;
  let high = -Infinity;
  for (const values of columns) {
    for (let index = 0; index < values.length; index += 1) {
      const value = values[index];
      if (!isNumber(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : null;
}

const PAD = 0.08;

/** The range of an axis: the data with a little air, and never less than `least`; a distance starts at zero. */
export function roomy(found, least, fromZero) {
  if (found === null) return [0, least];
  const [low, high] = found;
  if (fromZero) return [0, Math.max(least, high * (1 + PAD))];
  const span = Math.max(least, high - low) * (1 + 2 * PAD);
  const middle = (low + high) / 2;
  return [middle - span / 2, middle + span / 2];
}
