/** Jogging on this page: what is held goes to the rig, and everything that takes the hand away ends it. */
import { isAsked } from "../keys/typing.js";
import { PAGE_ID } from "../live/page_id.js";
import { post } from "../live/rest.js";
import { heedStop } from "../live/stop.js";
import { obstacleIn } from "../operator/words.js";
import { get, set } from "../store.js";
import { createHold } from "./hold.js";

export const SLOWEST_DEG_S = 5;

/** @type {Partial<Record<import("../types").RigState, string>>} */
const WAYS = {
  disarmed: "Arm the rig to jog.",
  running: "A run is on: stop it to jog.",
  held: "The rig is on hold: resume it, or disarm and arm, to jog.",
  fault: "Reset the rig and arm it to jog.",
};

/** Why nothing may be driven by hand just now, "" when it may. @param {import("../types").State} state */
export function obstacleOf({ connection, tick, operator }) {
  if (connection.status !== "open") return "There is no connection to the rig: nothing is sent.";
  if (!tick) return "Waiting for the rig…";
  return obstacleIn(operator) || (WAYS[tick.rig] ?? "");
}

function obstacle() {
  if (document.hidden || !document.hasFocus()) return "Stopped: this page is not in front.";
  if (isAsked()) return "Stopped: a question is open.";
  return obstacleOf(get());
}

/** @param {Partial<import("../types").State["jog"]>} part */
const change = (part) => set({ jog: { ...get().jog, ...part } });
/** @param {import("./hold.js").Command} command */
const body = (command) => ({ ...command, hand: PAGE_ID });

const hold = createHold({
  send: (command, signal) => post("/manual", body(command), { signal }),
  // Whether it arrives or not: without it the rig stops 300 ms later.
  sendLast: (command) => void post("/manual", body(command), { keepalive: true, priority: "high" }).catch(() => {}),
  obstacle,
  changed: (held, refusal) => change({ held, refusal }),
});

export const { press, change: changeSwing, release, stop: stopJog, isHeldBy } = hold;

/**
 * About an end, `sense` 1 to the left, at the rate of the slider.
 * @param {1 | -1} pivot
 * @param {1 | -1} sense
 */
export function swing(pivot, sense) {
  return swingAt(pivot, sense * get().jog.rate_deg_s);
}

/**
 * The field is tilted as the gait's form says.
 * @param {1 | -1} pivot
 * @param {number} rate_deg_s
 * @returns {import("./hold.js").Swing}
 */
export function swingAt(pivot, rate_deg_s) {
  const tilt_deg = get().selection?.gait.tilt_deg;
  return typeof tilt_deg === "number" ? { pivot, rate_deg_s, tilt_deg } : { pivot, rate_deg_s };
}

/** @param {number} rate_deg_s */
export const setRate = (rate_deg_s) => change({ rate_deg_s });

/** @param {boolean} on */
export function switchJog(on) {
  stopJog();
  change({ on, refusal: "" });
}

/** While the jog is on: whatever takes the hand or the eye away. @returns {() => void} ends the watch and the jog */
export function watchHand() {
  const lost = () => isHeld() && stopJog("Stopped: this page is not in front.");
  const hidden = () => document.hidden && lost();
  addEventListener("blur", lost);
  addEventListener("pagehide", lost);
  document.addEventListener("visibilitychange", hidden);
  document.addEventListener("freeze", lost);
  const deaf = heedStop(() => isHeld() && stopJog());
  return () => {
    removeEventListener("blur", lost);
    removeEventListener("pagehide", lost);
    document.removeEventListener("visibilitychange", hidden);
    document.removeEventListener("freeze", lost);
    deaf();
    stopJog();
  };
}

const isHeld = () => get().jog.held !== null;
