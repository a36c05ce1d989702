/** How each step stands: "done", "open", or "wrong" where something must be done. */
import { useStore } from "../store.js";
import { useSetup } from "./setup.js";

/** Steps in which the board may hide the robot. */
export const BOARD_STEPS = ["lens", "plane"];

export function useStanding() {
  const hidden = useSetup(({ step }) => BOARD_STEPS.includes(step));
  const seen = useStore(({ tick }) => (tick?.tracking === "lost" ? "lost" : tick ? "seen" : ""));
  const known = useSetup(({ calibration, star, latency }) => ({ calibration, star, latency })) ?? {};
  return {
    camera: seen ? "done" : "open",
    colour: seen === "seen" ? "done" : seen === "lost" && !hidden ? "wrong" : "open",
    lens: fit(known.calibration?.lens),
    plane: fit(known.calibration?.plane),
    robot: measured(known.star) && measured(known.latency) ? "done" : "open",
  };
}

const fit = (part) => (part ? (part.fits ? "done" : "wrong") : "open");

/** The rig file says of each figure where it comes from. */
const measured = (part) => Boolean(part?.in_use?.source) && part.in_use.source !== "not measured";
