/** Everything the page asks the rig to do; errors end as a message in words or beside a field. */
import { get, say, set } from "../store.js";
import { patch, post, Problem, put } from "./rest.js";

const STOP_TRIES = 3;
const STOP_PAUSE_MS = 250;
const EDIT_PAUSE_MS = 300;

const pause = (duration) => new Promise((resolve) => setTimeout(resolve, duration));

/** Zero now: from any state, tried again when the network swallows it. */
export async function stopNow() {
  set({ consentAsked: false });
  for (let attempt = 0; attempt < STOP_TRIES; attempt += 1) {
    try {
      await post("/estop", {}, { keepalive: true, priority: "high" });
      return;
    } catch (problem) {
      if (attempt === STOP_TRIES - 1) say(stopFailure(problem));
    }
    await pause(STOP_PAUSE_MS);
  }
}

const stopFailure = (problem) =>
  `STOP did not reach the rig (${problem.message}) Switch the supply off if it moves: ` +
  "by itself the board zeroes the coils only when the server falls silent.";

async function act(name, call) {
  if (get().busy) return;
  set({ busy: name });
  try {
    await call();
  } catch (problem) {
    report(problem);
  } finally {
    set({ busy: null });
  }
}

/** Beside its field where there is one, as a message otherwise. */
function report(problem) {
  if (!(problem instanceof Problem)) throw problem;
  set({ serverErrors: problem.fields });
  const keys = Object.keys(problem.fields);
  if (keys.length === 0 || !keys.every(hasPlace)) say(problem.message);
}

/** Whether the form shows what is wrong with "gait", or "gait.sweep_deg". */
function hasPlace(key) {
  const [part, name] = key.split(".");
  const { selection, controllers, trajectories, gaitSchema } = get();
  if (!selection || !(part in selection)) return false;
  if (name === undefined) return part !== "gait";
  const entries = { controller: controllers, trajectory: trajectories }[part] ?? [];
  const schema = part === "gait" ? gaitSchema : entries.find((entry) => entry.name === selection[part].name)?.parameters;
  return name in (schema?.properties ?? {});
}

/** A simulated rig is armed at once; a real one asks first. */
export const arm = () => (get().tick?.simulated ? act("arm", () => post("/arm")) : set({ consentAsked: true }));

export const armWithConsent = () => {
  set({ consentAsked: false });
  return act("arm", () => post("/arm", { consent: true }));
};
export const disarm = () => act("disarm", () => post("/disarm"));
export const reset = () => act("reset", () => post("/reset"));
export const pauseRun = () => act("pause", () => post("/runs/current/pause"));
export const resumeRun = () => act("resume", () => post("/runs/current/resume"));
export const stopRun = () => act("stop run", () => post("/runs/current/stop"));

/** Tells the rig which of the things that look alike is the robot, by its place in the picture, px. */
export const followAt = (u, v) => act("follow", () => post("/vision/follow", { u, v }));

export const reloadRigFile = () => act("reload rig file", () => post("/rig/reload"));

export const startRun = () =>
  act("start", async () => {
    refuseDrafts();
    await sendSelection();
    await post("/runs", { passes: get().passes });
  });

/** Takes the values of the form over into the run that is going on. */
export const applyToRun = () =>
  act("apply", async () => {
    refuseDrafts();
    await sendSelection();
    const { controller, trajectory, gait } = get().selection;
    await patch("/runs/current", { controller, trajectory, gait });
  });

function refuseDrafts() {
  const texts = Object.values(get().draftErrors);
  if (texts.length > 0) throw new Problem(`One value cannot be used yet: ${texts[0]}`);
}

let editTimer = 0;
let edited = false;

/** Changes the selection at once on the page, and on the rig when typing pauses. */
export function select(change) {
  set({ selection: { ...get().selection, ...change }, serverErrors: {} });
  edited = true;
  clearTimeout(editTimer);
  editTimer = setTimeout(() => sendSelection().catch(report), EDIT_PAUSE_MS);
}

/** While this is so, the page's selection is newer than the rig's. */
export const hasUnsentEdits = () => edited;

async function sendSelection() {
  clearTimeout(editTimer);
  if (!edited) return;
  const sent = get().selection;
  await put("/selection", sent);
  edited = get().selection !== sent;
  set({ serverErrors: {} });
}

/** Asks for the picture of a path into `key` of the store; an older answer never replaces a newer one. */
function pathLoader(key) {
  let asked = 0;
  return async (trajectory) => {
    const own = (asked += 1);
    const path = trajectory ? await preview(trajectory) : null;
    if (own === asked) set({ [key]: path });
  };
}

async function preview({ name, parameters }) {
  try {
    return await post("/trajectories/preview", { name, parameters });
  } catch (problem) {
    // A path that cannot be walked has no picture; a silent server is the connection's story.
    if (problem.status !== 422 && problem.status !== 0) report(problem);
    return null;
  }
}

/** The path of the selection, and that of the run that is going on. */
export const showSelectedPath = pathLoader("path");
export const showRunPath = pathLoader("runPath");
