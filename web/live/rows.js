/** Numbers over time in typed arrays that never grow: the newest rows are kept, and looked at without a copy. */

/** One value a row and column, NaN where nothing is known. */
export class Rows {
  /**
   * @param {string[]} names of the columns beside the time
   * @param {number} kept rows that are kept at least
   */
  constructor(names, kept) {
    this.names = names;
    this.kept = kept;
    // With room to spare the rows are moved to the front seldom, and lie in one piece for whoever draws them.
    this.room = kept + Math.ceil(kept / 4);
    this.time_s = new Float64Array(this.room);
    /** @type {Record<string, Float32Array>} */
    this.columns = Object.fromEntries(names.map((name) => [name, new Float32Array(this.room)]));
    this.first = 0;
    this.end = 0;
  }

  get length() {
    return this.end - this.first;
  }

  /** Time of the newest row, s; NaN while there is none. */
  get newest_s() {
    return this.length > 0 ? this.time_s[this.end - 1] : NaN;
  }

  clear() {
    this.first = this.end = 0;
  }

  /**
   * @param {number} time_s later than all before
   * @param {Record<string, number | null | undefined>} values by column
   */
  append(time_s, values) {
    if (this.end === this.room) this.moveToFront();
    this.time_s[this.end] = time_s;
    for (const name of this.names) this.columns[name][this.end] = values[name] ?? NaN;
    this.end += 1;
    this.first = Math.max(this.first, this.end - this.kept);
  }

  moveToFront() {
    for (const values of [this.time_s, ...Object.values(this.columns)]) values.copyWithin(0, this.first, this.end);
    this.end -= this.first;
    this.first = 0;
  }

  /** Index of the last row that is not after `time_s`; one before the first row when there is none. @param {number} time_s */
  at(time_s) {
    let [low, high] = [this.first, this.end];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time_s[middle] <= time_s) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /**
   * The rows from one time to another and one more on each side, so that lines go on to the edge.
   * They are views: valid until the next row is appended.
   *
   * @param {number} from_s
   * @param {number} to_s
   * @param {string[]} names
   * @returns {(Float64Array | Float32Array)[]} times, then the columns
   */
  between(from_s, to_s, names) {
    const begin = Math.max(this.first, this.at(from_s));
    const end = Math.min(this.end, this.at(to_s) + 2);
    return [this.time_s.subarray(begin, end), ...names.map((name) => this.columns[name].subarray(begin, end))];
  }
}
