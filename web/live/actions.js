/** Everything the page asks the rig to do; errors end as a message in words or beside a field. */
import { get, say, set } from "../store.js";
import { patch, post, Problem } from "./rest.js";
import { onRefusedEdit, sendSelection } from "./selection.js";

/** One at a time: what is asked for meanwhile is not sent. @param {string} name @param {() => Promise<unknown>} call */
async function act(name, call) {
  if (get().busy) return;
  await send(name, call);
}

/** What takes the field away waits for nothing else under way: a start may be answered late. @param {string} name @param {() => Promise<unknown>} call */
async function calm(name, call) {
  if (get().busy === name) return;
  await send(name, call);
}

/** @param {string} name @param {() => Promise<unknown>} call */
async function send(name, call) {
  if (get().connection.status === "lost") return say(NOTHING_SENT);
  set({ busy: name });
  try {
    await call();
  } catch (problem) {
    report(problem);
  } finally {
    if (get().busy === name) set({ busy: null });
  }
}

const NOTHING_SENT = "There is no connection to the rig: nothing was sent.";

/** Beside its field where there is one, as a message otherwise. @param {unknown} problem */
export function report(problem) {
  if (!(problem instanceof Problem)) throw problem;
  set({ serverErrors: problem.fields });
  const keys = Object.keys(problem.fields);
  if (keys.length === 0 || !keys.every(hasPlace)) say(problem.message);
}

onRefusedEdit(report);

/** Whether the form shows what is wrong with "gait", or "gait.sweep_deg". @param {string} key */
function hasPlace(key) {
  const [part, name] = key.split(".");
  const { selection, controllers, trajectories, gaitSchema } = get();
  if (!selection) return false;
  const of = (/** @type {import("../types").Choice[]} */ entries, /** @type {string} */ chosen) =>
    entries.find((entry) => entry.name === chosen)?.parameters;
  if (part === "gait") return name !== undefined && name in (gaitSchema?.properties ?? {});
  if (part !== "controller" && part !== "trajectory") return false;
  const schema = of(part === "controller" ? controllers : trajectories, selection[part].name);
  return name === undefined || name in (schema?.properties ?? {});
}

/** A simulated rig is armed at once; a real one asks first. */
export const arm = () => (get().tick?.simulated ? act("arm", () => post("/arm")) : set({ consentAsked: true }));

export const armWithConsent = () => {
  set({ consentAsked: false });
  return act("arm", () => post("/arm", { consent: true }));
};
export const disarm = () => calm("disarm", () => post("/disarm"));
export const reset = () => act("reset", () => post("/reset"));
export const pauseRun = () => calm("pause", () => post("/runs/current/pause"));
export const resumeRun = () => act("resume", () => post("/runs/current/resume"));
export const stopRun = () => calm("stop run", () => post("/runs/current/stop"));

/** Tells the rig which of the things that look alike is the robot, by its place in the picture, px. @param {number} u @param {number} v */
export const followAt = (u, v) => act("follow", () => post("/vision/follow", { u, v }));

export const reloadRigFile = () => act("reload rig file", () => post("/rig/reload"));

/** What is said of the next run alone; it is said anew for each. */
export const NO_WORDS = { label: "", tags: [], unattended: false };

export const startRun = () =>
  act("start", async () => {
    refuseDrafts();
    await sendSelection();
    await post("/runs", { passes: get().passes, ...get().nextRun });
    set({ nextRun: NO_WORDS });
  });

/** Takes the values of the form over into the run that is going on. */
export const applyToRun = () =>
  act("apply", async () => {
    refuseDrafts();
    await sendSelection();
    const { selection } = get();
    if (!selection) return;
    const { controller, trajectory, gait } = selection;
    await patch("/runs/current", { controller, trajectory, gait });
  });

function refuseDrafts() {
  // What is being typed into the rig file concerns no run.
  const texts = Object.entries(get().draftErrors).filter(([key]) => !key.startsWith("rig.")).map(([, text]) => text);
  if (texts.length > 0) throw new Problem(`One value cannot be used yet: ${texts[0]}`);
}

/** Asks for the picture of a path into `key` of the store; an older answer never replaces a newer one. @param {string} key */
function pathLoader(key) {
  let asked = 0;
  return async (/** @type {import("../types").Chosen | null | undefined} */ trajectory) => {
    const own = (asked += 1);
    const path = trajectory ? await preview(trajectory) : null;
    if (own === asked) set({ [key]: path });
  };
}

/** @param {import("../types").Chosen} trajectory */
async function preview({ name, parameters }) {
  try {
    return await post("/trajectories/preview", { name, parameters });
  } catch (caught) {
    const problem = /** @type {Problem} */ (caught);
    // A path that cannot be walked has no picture; a silent server is the connection's story.
    if (problem.status !== 422 && problem.status !== 0) report(problem);
    return null;
  }
}

/** The path of the selection, and that of the run that is going on. */
export const showSelectedPath = pathLoader("path");
export const showRunPath = pathLoader("runPath");
