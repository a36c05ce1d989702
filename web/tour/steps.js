/** The three steps of the tour, and how what a person does moves it on. Pure. */

/** @typedef {{title: string, words: string, target: string}} Step target: the part of the page that is meant */

/** @type {Step[]} */
export const STEPS = [
  { title: "The robot and its camera", words: "This is the robot on its plate, seen by the camera. Lines show its path, where it is and where it shall be.", target: ".camera .picture" },
  { title: "Arm, then start", words: "Arm raises the field, and nothing walks yet. The same button then starts the robot along the path.", target: ".run .primary" },
  { title: "STOP", words: "Takes the current away at once, from anywhere: this button, or the keys Escape and Space. Try it whenever you like.", target: ".bar .stop" },
];

export const LAST = STEPS.length - 1;

/** After these the tour of another step is out of date: what it would tell has been done. */
const MOVING = ["running", "held"];

/**
 * @param {number} step the one that is shown
 * @param {string | undefined} before the rig's state
 * @param {string | undefined} after
 * @returns {number | null} the step to show now; null: the tour is over
 */
export function stepAfter(step, before, after) {
  if (before === undefined || after === undefined || before === after) return step;
  if (after === "fault") return step === LAST || before === "running" ? null : step;
  if (after === "armed") return Math.max(step, 1);
  return MOVING.includes(after) ? LAST : step;
}
