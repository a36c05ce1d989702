/** STOP: zero now, from any state. It asks nobody and waits for nothing. */
import { say, set } from "../store.js";
import { post, Problem } from "./rest.js";

const TRIES = 3;
const PAUSE_MS = 250;
/** The rig answers a STOP within 0.5 s; a network that swallows it would let one wait for minutes, ms. */
const PATIENCE_MS = 1500;

/** @param {number} duration ms */
const pause = (duration) => new Promise((resolve) => setTimeout(resolve, duration));

/** @type {Set<() => void>} */
const listeners = new Set();

/** Hears of a STOP on this page the moment it is asked for. @param {() => void} listener @returns {() => void} no longer */
export function heedStop(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Tried again when the network swallows it. */
export async function stopNow() {
  const told = tell();
  set({ consentAsked: false });
  for (const listener of listeners) listener();
  await told;
}

async function tell() {
  for (let attempt = 1; ; attempt += 1) {
    try {
      await answered(post("/estop", {}, { keepalive: true, priority: "high" }));
      return;
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      if (attempt === TRIES) {
        say(failure(problem));
        return;
      }
    }
    await pause(PAUSE_MS);
  }
}

/** A STOP that is late is not taken back: it may still arrive. @param {Promise<unknown>} request */
function answered(request) {
  const late = pause(PATIENCE_MS).then(() => Promise.reject(new Problem("No answer has come.")));
  return Promise.race([request, late]);
}

/** @param {Problem} problem */
const failure = (problem) =>
  `STOP did not reach the rig (${problem.message}) Switch the supply off if it moves: ` +
  "by itself the board zeroes the coils only when the server falls silent.";
