/**
 * A jog lasts for as long as somebody holds something down. Pure: what is sent, asked and shown is given to it.
 *
 * The rig swings for 300 ms at most after each command, so a page that dies or is cut off stops by itself; a page that
 * lives says so at once. Every command has a number: one that was overtaken on its way cannot start anything again.
 *
 * @typedef {{pivot: 1 | -1, rate_deg_s: number, tilt_deg?: number}} Swing
 * @typedef {Swing & {number: number}} Command
 *
 * @typedef {object} Surroundings
 * @property {(command: Command, signal: AbortSignal) => Promise<unknown>} send rejects with an Error in words
 * @property {(command: Command) => void} sendLast the last word: zero, also from a page that is being closed
 * @property {() => string} obstacle why nothing may be sent just now, "" when it may
 * @property {(held: {by: string, swing: Swing} | null, refusal: string) => void} changed
 */

/** Three renewals within the rig's 300 ms: one may be late, ms. */
export const RENEW_MS = 100;

/** @param {Surroundings} surroundings */
export function createHold({ send, sendLast, obstacle, changed }) {
  /** @type {{by: string, swing: Swing, waiting: boolean, end: AbortController, timer: any} | null} */
  let held = null;
  let number = 0;

  /** @param {string} by who holds; the newest counts @param {Swing} swing */
  function press(by, swing) {
    const refusal = obstacle();
    if (refusal) return stop(refusal);
    leave();
    const own = { by, swing, waiting: false, end: new AbortController(), timer: setInterval(renew, RENEW_MS) };
    held = own;
    changed({ by, swing }, "");
    renew();
  }

  /** Another rate or another end while it is held; whoever does not hold it changes nothing. @param {string} by @param {Swing} swing */
  function change(by, swing) {
    if (held === null || held.by !== by) return;
    const turned = held.swing.pivot !== swing.pivot || Math.sign(held.swing.rate_deg_s) !== Math.sign(swing.rate_deg_s);
    held.swing = swing;
    changed({ by, swing }, "");
    if (turned) renew();
  }

  /** @param {string} by */
  function release(by) {
    if (held?.by === by) stop();
  }

  /** Whoever holds it. @param {string} [why] in words, when it was not let go */
  function stop(why = "") {
    leave();
    changed(null, why);
  }

  function leave() {
    if (!held) return;
    const { swing, end, timer } = held;
    held = null;
    clearInterval(timer);
    end.abort();
    sendLast({ ...swing, rate_deg_s: 0, number: (number += 1) });
  }

  async function renew() {
    const own = held;
    if (!own) return;
    const refusal = obstacle();
    if (refusal) return stop(refusal);
    // No second one behind an answer that does not come: what is late must not pile up.
    if (own.waiting) return;
    own.waiting = true;
    try {
      await send({ ...own.swing, number: (number += 1) }, own.end.signal);
    } catch (problem) {
      if (own === held) stop(problem instanceof Error ? problem.message : String(problem));
    } finally {
      own.waiting = false;
    }
  }

  return { press, change, release, stop, isHeldBy: (/** @type {string} */ by) => held?.by === by };
}
