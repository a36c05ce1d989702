/** Reads what the page is made from: at each new connection, and again where the rig has changed. */
import { loadEvents } from "../log/listing.js";
import { loadFaults } from "../faults/catalogue.js";
import { loadOperator } from "../operator/lease.js";
import { loadRuns } from "../runs/listing.js";
import { get, say, set } from "../store.js";
import { loadStudies } from "../studies/listing.js";
import { showRunPath } from "./actions.js";
import { read } from "./rest.js";
import { adoptSelection } from "./selection.js";

const EDIT_LOST = "The last change of the settings had not been sent when the connection broke; the rig's own are shown.";

export async function load() {
  // Asked for first, since a browser asks for six things at a time: what is seen first is made from these.
  const first = Promise.all([loadStanding(), read("/runs?limit=1")]);
  loadOperator();
  loadRuns();
  loadStudies();
  loadEvents();
  const [, newest] = await first;
  follow(newest.runs.find((/** @type {import("../types").Run} */ { state }) => state === "running") ?? null);
}

/** The rig, what can be chosen, and what is chosen. */
async function loadStanding() {
  const [rig, camera, controllers, trajectories, gaitSchema, selection] = await Promise.all(
    ["/rig", "/camera", "/controllers", "/trajectories", "/gait", "/selection"].map(read),
  );
  set({ rig, camera, controllers, trajectories, gaitSchema });
  if (adoptSelection(selection)) say(EDIT_LOST, "info");
  if (rig.simulated) loadFaults();
}

/** The run that goes on, with its settings and the picture of its path. @param {import("../types").Run | null} run */
export function follow(run) {
  const isSame = run !== null && run.id === get().walked?.id;
  set({ walked: run, applying: isSame ? get().applying : {} });
  showRunPath(run?.trajectory);
}

let rigAsked = 0;

/**
 * The rig's values, its file and its camera, which change when somebody changes the rig file. Each change is told
 * twice within a moment; an older answer never replaces a newer one.
 */
export async function loadRig() {
  const own = (rigAsked += 1);
  const [rig, camera] = await Promise.all(["/rig", "/camera"].map(read));
  if (own === rigAsked) set({ rig, camera });
}

/** Somebody has saved, renamed or deleted a path. */
export async function loadTrajectories() {
  set({ trajectories: await read("/trajectories") });
}
