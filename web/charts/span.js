/** Which part of the time the charts show: the newest of it, or a part that stands still. Times in s. */

/** As much as is remembered (live/ticks.js), s. */
const LONGEST_S = 3600;
/** The choices of how far back the charts look, s, in words. */
export const WINDOWS = /** @type {[number, string][]} */ ([[10, "10 s"], [60, "1 min"], [600, "10 min"], [LONGEST_S, "1 h"]]);
/** Closer than this there is nothing more to see, s. */
const CLOSEST_S = 0.2;

/**
 * @typedef {object} View what the charts of the rig show
 * @property {number} window_s
 * @property {[number, number] | null} held what is shown while the charts are paused
 * @property {[number, number] | null} zoom a part that somebody looks closer at
 */

/** @param {View} view @param {number} newest @returns {[number, number]} */
export const shownSpan = ({ window_s, held, zoom }, newest) => zoom ?? held ?? [newest - window_s, newest];

/** @param {View} view */
export const standsStill = ({ held, zoom }) => held !== null || zoom !== null;

/** Stand still, or go on with what is new. @returns {View} */
export const toggled = (view, newest) =>
  standsStill(view) ? { ...view, held: null, zoom: null } : { ...view, held: shownSpan(view, newest) };

/** @param {View} view @param {[number, number]} part @returns {View} */
export const zoomedTo = (view, [from, to]) =>
  to - from < CLOSEST_S ? view : { ...view, zoom: [from, to] };

/**
 * Closer (factor < 1) or further away, about a time that stays where it is; from no more than the longest window.
 *
 * @returns {View}
 */
export function zoomedBy(view, newest, factor, about) {
  const [from, to] = shownSpan(view, newest);
  const scale = Math.min(factor, LONGEST_S / (to - from));
  return zoomedTo(view, within([about - (about - from) * scale, about + (to - about) * scale], newest));
}

/** Earlier or later; what is live begins to stand still. @returns {View} */
export function shiftedBy(view, newest, seconds) {
  const [from, to] = shownSpan(view, newest);
  return zoomedTo(view, within([from + seconds, to + seconds], newest));
}

/** There is nothing after the newest. @returns {[number, number]} */
const within = ([from, to], newest) => (to > newest ? [from - (to - newest), newest] : [from, to]);

/** The window in words, for a name: "over the last 10 minutes". */
export function spanWords({ window_s, held, zoom }) {
  if (zoom !== null) return "of the part that is looked at";
  if (held !== null) return "up to when they were paused";
  if (window_s < 120) return `over the last ${window_s} seconds`;
  return window_s < 3600 ? `over the last ${window_s / 60} minutes` : "over the last hour";
}
