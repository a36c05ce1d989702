/** What the camera's setup knows, asks and does: every answer lands in the store's `setup`, errors at their place. */
import { amend, get, set, useStore } from "../store.js";
import { post, Problem, read } from "../live/rest.js";

export const STEPS = ["camera", "colour", "lens", "plane", "robot"];

const CLOSED = {
  step: "camera",
  /** Answers of the server, null until they come. */
  cameras: null, vision: null, calibration: null, star: null, latency: null,
  /** {place, words} of what goes on, or null. */
  working: null,
  /** What the newest view of the board showed: {newest: [[u, v]] or null, hint}; who takes views; the board that
      is shown to a simulated camera: "flat", "next" or null. */
  found: null, taking: null, board: null,
  /** Place of an action -> what went wrong with it, and what was done; the rig's values after the newest save. */
  errors: {}, done: {}, saved: "",
};

/** Where each answer comes from. */
const SOURCES = {
  cameras: "/cameras", vision: "/vision", calibration: "/calibration", star: "/calibration/star", latency: "/calibration/latency",
};

export const useSetup = (select) => useStore((state) => (state.setup ? select(state.setup) : null));

/** @param {Partial<import("../types").Setup>} part */
export const change = (part) => amend("setup", part);

export function openSetup() {
  set({ setup: CLOSED });
  learn("cameras");
  learnOfRig();
}

export const closeSetup = () => set({ setup: null });

/** What was said of one step does not stay for the next, but what could not be read at all does. */
export function goTo(step) {
  const { setup } = get();
  if (!setup) return;
  const unread = Object.keys(SOURCES).filter((name) => setup[name] === null).map((name) => [name, setup.errors[name]]);
  change({ step, errors: Object.fromEntries(unread), done: {} });
}

/** Name of an answer -> number of the newest question, and of the newest one that was answered. */
const asked = {};
const answered = {};

/** Reads one of the answers again; what cannot be read is said at its place. A late answer to an earlier question
    does not count any more. */
export async function learn(name) {
  const turn = (asked[name] = (asked[name] ?? 0) + 1);
  try {
    const answer = await read(SOURCES[name]);
    if (turn < answered[name]) return;
    answered[name] = turn;
    change(name === "calibration" ? { calibration: answer, board: answer.session.board_shown } : { [name]: answer });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    note("errors", name, problem.message);
  }
}

export function note(kind, place, text) {
  const { setup } = get();
  if (setup) change({ [kind]: { ...setup[kind], [place]: text } });
}

/**
 * Does one thing at a time and says so meanwhile.
 * @param place where an error is shown; words: "Looking for the board"; call: the work
 * @returns what `call` answers, or null when it was refused or something else goes on
 */
export async function doing(place, words, call) {
  const { setup } = get();
  if (!setup || setup.working) return null;
  change({ working: { place, words }, errors: { ...setup.errors, [place]: "" }, done: { ...setup.done, [place]: "" } });
  try {
    return (await call()) ?? true;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    note("errors", place, problem.message);
    return null;
  } finally {
    change({ working: null });
  }
}

/** The same for what ends in the rig file: afterwards it can be undone at this place. */
export async function saving(place, words, call) {
  const answer = await doing(place, words, call);
  if (answer === null) return null;
  const rig = await readRig();
  change({ saved: rig && valuesOf(rig), done: { [place]: "saved" } });
  return answer;
}

/** The rig's values and file for the whole page; null when the server does not answer, which the page says. */
async function readRig() {
  const rig = await read("/rig").catch(() => null);
  if (rig) set({ rig });
  return rig;
}

/** A rig's values as text, without what is said of its file. */
const valuesOf = ({ file, ...values }) => JSON.stringify(values);

/** The rig file as it was before the last save; not once somebody else has saved after that. */
export async function undo(place) {
  const answer = await doing(place, "Undoing", async () => {
    if (valuesOf(await read("/rig")) !== get().setup?.saved) throw new Problem(ELSEWHERE);
    return post("/rig/undo");
  });
  if (answer === null) return;
  await readRig();
  note("done", place, "undone");
}

const ELSEWHERE = "Somebody else has changed the rig file since; an undo would take that back instead.";

/** Somebody has changed the rig: what is known of it is asked again. */
export const learnOfRig = () => Promise.all(["vision", "calibration", "star", "latency"].map(learn));
