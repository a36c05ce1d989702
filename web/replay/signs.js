/** Small things that each part of a replay shows: that it is one, and numbers of its time. Words only. */
import { fixed } from "../units.js";
import { html } from "../view.js";

/** On every card that shows a recording, so that nobody takes it for the rig. */
export const Badge = () => html`<span class="badge replay-badge">Replay</span>`;

/** "0:07.4", "12:05.0"; digits: after the seconds, at least one. */
export function stamp(seconds, digits = 1) {
  const parts = 10 ** digits;
  const count = Math.round(Math.max(0, seconds) * parts);
  const whole = Math.floor(count / parts);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}.${String(count % parts).padStart(digits, "0")}`;
}

/** "0.25×", "2×". */
export const speedWords = (speed) => `${String(speed)}×`;

/** Which of two runs: a full line or a dashed one, as in the charts. */
export const Line = ({ index }) => html`<span class="replay-line" data-run=${index} aria-hidden="true"></span>`;

/** "0.42", with a sign: what the second has more than the first. */
export function difference(first, second, digits) {
  if (typeof first !== "number" || typeof second !== "number") return "–";
  const text = fixed(second - first, digits);
  return second - first > 0 && Number(second.toFixed(digits)) !== Number(first.toFixed(digits)) ? `+${text}` : text;
}
