/**
 * A gamepad as a jog: the stick that is tilted chooses the end to stand on, how far it is tilted the rate, and one of
 * the shoulder buttons must be held all the while. Pure.
 */

/** Buttons of the standard layout that are held with a forefinger: LB and RB. */
const DEAD_MAN_BUTTONS = [4, 5];
/** Sticks of the standard layout: [axis left to right, pivot]. */
const STICKS = [[0, 1], [2, -1]];
/** A stick that is let go does not come to rest at exactly zero. */
const REST = 0.2;

/**
 * @typedef {{connected: boolean, mapping: string, axes: readonly number[], buttons: readonly {pressed: boolean}[]}} Pad
 * @param {Pad} pad
 * @param {number} fastest_deg_s at full tilt
 * @returns {{deadMan: boolean, pivot: 1 | -1, rate_deg_s: number}} rate 0: the sticks rest
 */
export function readPad(pad, fastest_deg_s) {
  const deadMan = pad.connected && DEAD_MAN_BUTTONS.some((button) => pad.buttons[button]?.pressed ?? false);
  const tilted = STICKS.map(([axis, pivot]) => ({ pivot, tilt: deflection(pad.axes[axis]) }));
  const [{ pivot, tilt }] = tilted.sort((a, b) => Math.abs(b.tilt) - Math.abs(a.tilt));
  // To the left is counter-clockwise, which is positive.
  return { deadMan, pivot: pivot === 1 ? 1 : -1, rate_deg_s: tilt === 0 ? 0 : -tilt * fastest_deg_s };
}

/** From -1 to 1; what is no number, or within the stick's rest, is 0. @param {number} value */
function deflection(value) {
  if (!Number.isFinite(value) || Math.abs(value) < REST) return 0;
  return Math.sign(value) * Math.min(1, (Math.abs(value) - REST) / (1 - REST));
}

/** The first one with the layout that is known. @param {readonly (Pad | null)[]} pads @returns {Pad | null} */
export const firstPad = (pads) => [...pads].find((pad) => pad?.connected && pad.mapping === "standard") ?? null;

/**
 * What to do at each look at the gamepad. A swing begins only once button and stick were at rest at the same time: what
 * is held down from before, or through a stop, starts nothing.
 * @param {{press: (swing: any) => void, change: (swing: any) => void, release: () => void, isHeld: () => boolean}} hand
 */
export function createStickWatch({ press, change, release, isHeld }) {
  let rested = false;

  /** @param {Pad | null} pad @param {(read: {pivot: 1 | -1, rate_deg_s: number}) => any} swingOf */
  return function look(pad, swingOf, fastest_deg_s = 0) {
    const read = pad ? readPad(pad, fastest_deg_s) : null;
    const wants = read !== null && read.deadMan && read.rate_deg_s !== 0;
    if (!wants) {
      if (isHeld()) release();
      rested = read !== null && (rested || !read.deadMan);
      return;
    }
    if (isHeld()) change(swingOf(read));
    else if (rested) {
      rested = false;
      press(swingOf(read));
    }
  };
}
