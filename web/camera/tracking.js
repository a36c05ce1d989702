/** What the camera knows, in words. */
import { fixed } from "../units.js";

/** A picture older than this says so on itself, s. */
export const STALE_S = 0.5;

export function trackingWords(tick) {
  if (!tick) return "waiting for the rig";
  if (tick.tracking === "locked") return "locked";
  if (tick.tracking === "predicted") return `predicted for ${fixed(tick.tracking_age_s, 2)} s`;
  return typeof tick.tracking_age_s === "number" ? `lost for ${fixed(tick.tracking_age_s, 1)} s` : "lost";
}

/** Why the robot is not seen, or what stands beside it, in the rig's words; "" when there is nothing to say. */
export const trackingReason = (tick) => tick?.tracking_reason ?? "";

/** Several things look like the robot, and the rig does not drive: somebody may say which one it is. */
export const mayBeTold = (tick) => (tick?.rivals_px?.length ?? 0) > 0 && tick.tracking !== "locked" && ["disarmed", "held"].includes(tick.rig);

/** Age of what is on the screen: of the picture here, or of the frame that the rig last saw. */
export function frameAge(pictureAge, tick) {
  if (pictureAge === null) return null;
  const rigAge = tick && typeof tick.captured_s === "number" ? tick.time_s - tick.captured_s : 0;
  return Math.max(pictureAge, rigAge);
}
