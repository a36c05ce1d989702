/** Rows of telemetry as a table that every program reads. */

const DIGITS = 4;

/**
 * @param {import("../live/rows.js").Rows} rows
 * @param {[number, number]} span s
 * @param {string[]} names of the columns, each with its unit
 * @returns {string[]} lines in parts, for a Blob: the time in s, empty cells for what was not known
 */
export function csvParts(rows, [from, to], names) {
  const parts = [`${["time_s", ...names].join(",")}\n`];
  const columns = names.map((name) => rows.columns[name]);
  for (let index = Math.max(rows.first, rows.at(from)); index < rows.end && rows.time_s[index] <= to; index += 1) {
    if (rows.time_s[index] < from) continue;
    const cells = columns.map((values) => (Number.isNaN(values[index]) ? "" : values[index].toFixed(DIGITS)));
    parts.push(`${rows.time_s[index].toFixed(DIGITS)},${cells.join(",")}\n`);
  }
  return parts;
}
