/**
 * How late what comes is, by the server's own clock: telemetry that arrives in order and steadily may still be old, when a
 * slow network holds it back or a page was asleep. Pure.
 *
 * The two clocks have no common zero, so the promptest message lately is taken for one that was not late at all.
 */

/** The promptest is forgotten so slowly that a clock which runs 1 % slower is not taken for a late network. */
const FORGET = 0.01;

/** @returns {(sent_ms: number, now_ms: number) => number} how late a message that was sent then is, ms */
export function createLateness() {
  /** Server's time less page's time of the promptest message, ms; when it was last looked at, ms. */
  let promptest = -Infinity;
  let looked = 0;
  return function lateness(sent_ms, now_ms) {
    const ahead = sent_ms - now_ms;
    promptest = Math.max(ahead, promptest - FORGET * Math.max(0, now_ms - looked));
    looked = now_ms;
    return promptest - ahead;
  };
}
