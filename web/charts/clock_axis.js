/** Where an axis of time has its marks, and what stands beside them. */

const STEPS_S = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800];
/** A mark with its time needs this much room, CSS px. */
const MARK_PX = 62;
/** Below this there is room for three, CSS px. */
const NARROW_PX = 190;
const PARTS = [1, 0.75, 0.5, 0.25, 0];
const FEW = [1, 0.5, 0];

const partsFor = (width) => (width < NARROW_PX ? FEW : PARTS);

/** Of a window that ends now. @param width of the axis, CSS px */
export const agoSplits = ([from, to], width) => partsFor(width).map((part) => to - part * (to - from));

export function agoWords([from, to], width) {
  const window_s = to - from;
  const [unit, size] = window_s > 120 ? ["min", 60] : ["s", 1];
  return partsFor(width).map((part) => (part === 0 ? "now" : `−${Number(((part * window_s) / size).toFixed(1))} ${unit}`));
}

const stepOf = ([from, to], width) => STEPS_S.find((step) => (to - from) / step <= Math.max(1, width / MARK_PX)) ?? 1800;

/** At round times of the clock on the wall, for a part that stands still. @param clock_s added to a time, for the clock's */
export function clockSplits([from, to], clock_s, width) {
  const step = stepOf([from, to], width);
  const first = Math.ceil((from + clock_s) / step);
  const count = Math.max(0, Math.floor((to + clock_s) / step) - first + 1);
  return Array.from({ length: count }, (_, index) => (first + index) * step - clock_s);
}

export const clockWords = (span, clock_s, width) =>
  clockSplits(span, clock_s, width).map((time) => clockTime(time + clock_s, stepOf(span, width) < 1 ? 1 : 0));

/** "14:03:22", with as many decimals. @param time_s since 1970 */
export function clockTime(time_s, digits = 0) {
  const rounded = Math.round(time_s * 10 ** digits) / 10 ** digits;
  const time = new Date(rounded * 1000);
  const two = (number) => String(number).padStart(2, "0");
  const seconds = (time.getSeconds() + time.getMilliseconds() / 1000).toFixed(digits).padStart(digits ? 3 + digits : 2, "0");
  return `${two(time.getHours())}:${two(time.getMinutes())}:${seconds}`;
}
