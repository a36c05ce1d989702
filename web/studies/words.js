/** Studies in words: states, counts, times, axes and values. Pure. */
import { clock, fixed, unitSign } from "../units.js";
import { counted } from "../runs/words.js";

/** What a figure of a study may show: [name, words, unit, decimals]. */
export const METRICS = [
  ["normalized_mean_error", "ME", "robot lengths", 3],
  ["mean_error_mm", "Mean error", "mm", 2],
  ["max_error_mm", "Largest error", "mm", 2],
  ["steps", "Steps", "", 0],
];

export const metricOf = (name) => METRICS.find(([each]) => each === name) ?? [name, name.replaceAll("_", " "), "", 3];

/** "ME in robot lengths". */
export function metricTitle([, words, unit]) {
  return unit ? `${words} in ${unit}` : words;
}

/** "0.213 ± 0.012", "0.213": the mean, and half the width of its 95 % interval where there is one. */
export function withInterval({ mean, low, high }, digits) {
  if (!Number.isFinite(mean)) return "–";
  const half = (high - low) / 2;
  return Number.isFinite(half) && high !== null && low !== null ? `${fixed(mean, digits)} ± ${fixed(half, digits)}` : fixed(mean, digits);
}

const MINUTE = 60;
const HOUR = 3600;
const DAY = 86400;

/** "20 s", "12 min", "5 h 20 min", "2 days 3 h": as exact as an estimate can be. */
export function roughly(seconds) {
  if (typeof seconds !== "number" || !Number.isFinite(seconds)) return "–";
  if (seconds < 100) return `${Math.max(1, Math.round(seconds))} s`;
  if (seconds < 100 * MINUTE) return `${Math.round(seconds / MINUTE)} min`;
  const minutes = Math.round(seconds / MINUTE);
  if (minutes < DAY / MINUTE) return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
  const hours = Math.round(seconds / HOUR);
  return `${counted(Math.floor(hours / 24), "day")} ${hours % 24} h`;
}

/** "412 of 630 runs, 3 failed, 1:20 min left". */
export function progressWords({ done, total, failed, state, seconds_left }) {
  const parts = [`${done.toLocaleString("en")} of ${counted(total, "run")}`];
  if (failed > 0) parts.push(`${failed.toLocaleString("en")} failed`);
  if (state === "running" && Number.isFinite(seconds_left)) parts.push(seconds_left < 600 ? `${clock(seconds_left)} min left` : `${roughly(seconds_left)} left`);
  return parts.join(", ");
}

export const onWords = (on) => (on === "rig" ? "on this rig" : "simulated batch");

/** 12.5, "geometric", "constant speed". */
export function valueText(value) {
  if (typeof value === "number") return String(Number(value.toPrecision(6))).replace("-", "−");
  if (value === null || value === undefined) return "–";
  return typeof value === "string" ? value.replaceAll("_", " ") : JSON.stringify(value);
}

/** "25°", "0.1 s", "geometric". */
export function valueWithUnit(value, axis) {
  const sign = typeof value === "number" ? unitSign(axis?.unit) : "";
  return `${valueText(value)}${sign === "°" || sign === "" ? "" : " "}${sign}`;
}

/** "Tilt in °", "Controller". */
export function axisTitle(axis) {
  const sign = unitSign(axis.unit);
  return sign ? `${axis.title} in ${sign}` : axis.title;
}

/** "tilt 25°, path step 0.1 s". */
export function setText(values, axes) {
  return axes.map((axis) => `${axis.title.toLowerCase()} ${valueWithUnit(values[axis.name], axis)}`).join(", ");
}
