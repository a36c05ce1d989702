/**
 * The colour scale of the maps: "cividis" (Nuñez, Anderton and Renslow 2018), which grows evenly in lightness and
 * looks nearly the same to people who do not tell red from green. Dark is little. Pure.
 */
const STOPS = [
  [0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115],
  [138, 134, 120], [165, 156, 116], [195, 179, 105], [225, 204, 85], [254, 232, 56],
];
/** Relative luminance above which black is read better than white: both have the same contrast there. */
const BLACK_ABOVE = 0.179;

/** @param share 0 to 1. @returns [r, g, b], 0 to 255 */
function mixed(share) {
  const place = Math.min(1, Math.max(0, share)) * (STOPS.length - 1);
  const index = Math.min(STOPS.length - 2, Math.floor(place));
  return STOPS[index].map((from, channel) => Math.round(from + (STOPS[index + 1][channel] - from) * (place - index)));
}

const linear = (channel) => (channel <= 10 ? channel / 255 / 12.92 : ((channel / 255 + 0.055) / 1.055) ** 2.4);

export const colourAt = (share) => `rgb(${mixed(share).join(" ")})`;

/** What is written on that colour. */
export function inkAt(share) {
  const [red, green, blue] = mixed(share).map(linear);
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > BLACK_ABOVE ? "#000000" : "#ffffff";
}

/**
 * @returns {{low: number, high: number, share: (value: number) => number} | null} where a value stands between the least
 *          and the largest of them; null of none
 */
export function scaleOf(values) {
  const known = values.filter(Number.isFinite);
  if (known.length === 0) return null;
  const [low, high] = [Math.min(...known), Math.max(...known)];
  return { low, high, share: (value) => (high > low ? (value - low) / (high - low) : 0.5) };
}

export const GRADIENT = STOPS.map((_, index) => [index / (STOPS.length - 1), colourAt(index / (STOPS.length - 1))]);
