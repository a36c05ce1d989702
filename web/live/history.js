/** An hour of telemetry, at full rate and in coarser levels, so that a drawing of an hour costs that of a minute. */
import { Rows } from "./rows.js";

/** Rows further apart than this are two stories: the line between them is not drawn, s. */
export const GAP_S = 1;
/** Each level has the lowest and the highest value of pieces this long, s. */
const LEVELS_S = [0.25, 1, 4];

/** @typedef {Record<string, number | null | undefined>} Values by column, null for what is not known */

/** The lowest and the highest value of each piece of the time, as two rows a piece. */
class Level {
  /** @param {string[]} names @param {number} piece_s @param {number} kept_s */
  constructor(names, piece_s, kept_s) {
    this.piece_s = piece_s;
    this.rows = new Rows(names, 2 * Math.ceil(kept_s / piece_s));
    this.piece = -1;
  }

  clear() {
    this.rows.clear();
    this.piece = -1;
  }

  /** @param {number} time_s @param {Values} values @param {boolean} gap the rows before are another story */
  add(time_s, values, gap) {
    const piece = Math.floor(time_s / this.piece_s);
    if (piece === this.piece) {
      this.widen(values);
      return;
    }
    if (gap && this.piece >= 0) this.rows.append((this.piece + 1) * this.piece_s, {});
    this.piece = piece;
    this.rows.append((piece + 0.25) * this.piece_s, values);
    this.rows.append((piece + 0.75) * this.piece_s, values);
  }

  /** @param {Values} values */
  widen(values) {
    const high = this.rows.end - 1;
    for (const name of this.rows.names) {
      const value = values[name];
      const column = this.rows.columns[name];
      if (typeof value !== "number") continue;
      // In this form a first value takes the place of NaN.
      if (!(column[high - 1] <= value)) column[high - 1] = value;
      if (!(column[high] >= value)) column[high] = value;
    }
  }
}

export class History {
  /**
   * @param {string[]} names of the columns beside the time
   * @param {number} kept_s
   * @param {number} rate_Hz that rows come at, at most
   */
  constructor(names, kept_s, rate_Hz) {
    this.rows = new Rows(names, kept_s * rate_Hz);
    this.levels = LEVELS_S.map((piece_s) => new Level(names, piece_s, kept_s));
  }

  get newest_s() {
    return this.rows.newest_s;
  }

  clear() {
    this.rows.clear();
    for (const level of this.levels) level.clear();
  }

  /** @param {number} time_s @param {Values} values */
  append(time_s, values) {
    const gap = time_s - this.newest_s > GAP_S;
    if (gap) this.rows.append(this.newest_s + GAP_S / 2, {});
    this.rows.append(time_s, values);
    for (const level of this.levels) level.add(time_s, values, gap);
  }

  /**
   * What is to be drawn from one time to another: the coarsest rows that are finer than a pixel.
   *
   * @param {number} from_s
   * @param {number} to_s
   * @param {number} pixels that the time has on the screen
   * @param {string[]} names
   */
  drawn(from_s, to_s, pixels, names) {
    const pixel_s = (to_s - from_s) / Math.max(1, pixels);
    const level = this.levels.findLast(({ piece_s }) => piece_s <= pixel_s);
    return (level?.rows ?? this.rows).between(from_s, to_s, names);
  }

  /** The values at a time, in the order of the names; null for what was not known. @param {number} time_s @param {string[]} names */
  valuesAt(time_s, names) {
    const index = this.rows.at(time_s);
    if (index < this.rows.first) return names.map(() => null);
    return names.map((name) => {
      const value = this.rows.columns[name][index];
      return Number.isNaN(value) ? null : value;
    });
  }
}
