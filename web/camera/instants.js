/**
 * What was known when a picture was taken. A picture is older than the newest tick by exposure, way and decoding;
 * an overlay of the newest tick would run ahead of the robot on the picture. Pure.
 */
import { wrapDegrees } from "../units.js";

/** Ticks that are kept: three seconds of them, a slow network's worst. */
const CAPACITY = 90;
/** A picture that is older than this stands still, and says so; what is drawn over it goes on, s. */
const STANDING_S = 1;

export function createInstants() {
  /** @type {any[]} oldest first */
  let ticks = [];

  return {
    /** A clock that goes back is another server's. */
    add(tick) {
      if (ticks.length > 0 && tick.time_s < ticks[ticks.length - 1].time_s) ticks = [];
      ticks.push(tick);
      if (ticks.length > CAPACITY) ticks.shift();
    },

    /**
     * The tick of the picture: what was seen in it, and the pose and target at the time of its capture.
     * @param {number | null | undefined} captured_s on the clock of the ticks
     * @returns {any} null before the first tick
     */
    at(captured_s) {
      const newest = ticks[ticks.length - 1] ?? null;
      if (newest === null || typeof captured_s !== "number" || newest.time_s - captured_s > STANDING_S) return newest;
      const seen = seenAt(ticks, captured_s);
      const after = ticks.findIndex(({ time_s }) => time_s >= captured_s);
      if (after <= 0) return seen;
      const [here, there] = [ticks[after - 1], ticks[after]];
      const share = (captured_s - here.time_s) / (there.time_s - here.time_s || 1);
      return { ...seen, pose: between(here.pose, there.pose, share), reference: between(here.reference, there.reference, share) };
    },
  };
}

/** The newest of the ticks whose frame is nearest to that time. */
function seenAt(ticks, captured_s) {
  const apart = (tick) => (typeof tick.captured_s === "number" ? Math.abs(tick.captured_s - captured_s) : Infinity);
  return ticks.reduce((best, tick) => (apart(tick) <= apart(best) ? tick : best), ticks[0]);
}

/** Places further apart than this are not one movement, mm. */
const JUMP_MM = 5;

function between(here, there, share) {
  if (!here || !there) return share < 0.5 ? here : there;
  if (Math.hypot(there.x_mm - here.x_mm, there.y_mm - here.y_mm) > JUMP_MM) return share < 0.5 ? here : there;
  const mixed = { ...there, x_mm: mix(here.x_mm, there.x_mm, share), y_mm: mix(here.y_mm, there.y_mm, share) };
  if (typeof here.heading_deg !== "number" || typeof there.heading_deg !== "number") return mixed;
  return { ...mixed, heading_deg: here.heading_deg + share * wrapDegrees(there.heading_deg - here.heading_deg) };
}

const mix = (one, other, share) => one + share * (other - one);
