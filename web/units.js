/** Numbers for people: fixed decimals so that nothing jumps, a true minus sign, and always the unit. */

/** @type {Record<string, string>} */
const UNIT_SIGNS = { deg: "°", "deg/s": "°/s", 1: "" };

/** @param {string | null} [unit] as a schema names it @returns {string} as people write it */
export const unitSign = (unit) => UNIT_SIGNS[unit ?? ""] ?? unit ?? "";

/** "12.3", "−0.4"; "–" for what is not known. @param {unknown} value */
export function fixed(value, digits = 1) {
  if (typeof value !== "number" || !Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  const rounded = Number(text) === 0 ? text.replace("-", "") : text;
  return rounded.replace("-", "−");
}

/** "12.3 mm", "87.2°". @param {unknown} value @param {string} unit */
export function quantity(value, unit, digits = 1) {
  const sign = unitSign(unit);
  return `${fixed(value, digits)}${sign === "°" ? "" : " "}${sign}`;
}

/** "0:42", "12:05". @param {unknown} seconds */
export function clock(seconds) {
  if (typeof seconds !== "number" || !Number.isFinite(seconds)) return "–";
  const whole = Math.max(0, Math.floor(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

/** The same angle in [-180, 180), degrees. @param {number} angle */
export const wrapDegrees = (angle) => ((((angle + 180) % 360) + 360) % 360) - 180;
