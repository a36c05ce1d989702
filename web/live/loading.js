/** Reads what the page is made from: at each new connection, and again where the rig has changed. */
import { loadEvents } from "../log/listing.js";
import { loadFaults } from "../faults/catalogue.js";
import { loadOperator } from "../operator/lease.js";
import { endIfGone } from "../replay/replay.js";
import { loadRuns } from "../runs/listing.js";
import { get, say, set } from "../store.js";
import { loadStudies } from "../studies/listing.js";
import { showRunPath } from "./actions.js";
import { question, subject } from "./order.js";
import { read } from "./rest.js";
import { adoptSelection, askForSelection } from "./selection.js";

const EDIT_LOST = "The last change of the settings had not been sent when the connection broke; the rig's own are shown.";

const rigs = subject();
const paths = subject();
const runs = subject();

export async function load() {
  // Asked for first, since a browser asks for six things at a time: what is seen first is made from these.
  const isUntold = question(runs);
  const first = Promise.all([loadStanding(), read("/runs?limit=1")]);
  loadOperator();
  loadRuns();
  loadStudies();
  loadEvents();
  endIfGone();
  const [, newest] = await first;
  if (isUntold()) follow(newest.runs.find((/** @type {import("../types").Run} */ { state }) => state === "running") ?? null);
}

/** The rig, what can be chosen, and what is chosen. */
async function loadStanding() {
  const [isNewestRig, areNewestPaths, isUnchosen] = [question(rigs), question(paths), askForSelection()];
  const [rig, camera, controllers, trajectories, gaitSchema, selection] = await Promise.all(
    ["/rig", "/camera", "/controllers", "/trajectories", "/gait", "/selection"].map(read),
  );
  set({ controllers, gaitSchema });
  if (isNewestRig()) set({ rig, camera });
  if (areNewestPaths()) set({ trajectories });
  if (isUnchosen() && adoptSelection(selection)) say(EDIT_LOST, "info");
  if (rig.simulated) loadFaults();
}

/** The run that goes on, with its settings and the picture of its path. @param {import("../types").Run | null} run */
export function follow(run) {
  question(runs);
  const isSame = run !== null && run.id === get().walked?.id;
  set({ walked: run, applying: isSame ? get().applying : {} });
  showRunPath(run?.trajectory);
}

/** The rig's values, its file and its camera, which change when somebody changes the rig file: told more than once. */
export async function loadRig() {
  const isNewest = question(rigs);
  const [rig, camera] = await Promise.all(["/rig", "/camera"].map(read));
  if (isNewest()) set({ rig, camera });
}

/** Somebody has saved, renamed or deleted a path. */
export async function loadTrajectories() {
  const areNewest = question(paths);
  const trajectories = await read("/trajectories");
  if (areNewest()) set({ trajectories });
}
