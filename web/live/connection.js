/** Keeps the telemetry stream open, feeds ticks and store from it, and loads what the page is made from. */
import { endIfReplayed } from "../replay/replay.js";
import { reloadIfInspected } from "../runs/inspected.js";
import { hearOfRun, loadRuns } from "../runs/listing.js";
import { get, say, set } from "../store.js";
import { hearOfStudy, loadStudies } from "../studies/listing.js";
import { hasUnsentEdits, showRunPath } from "./actions.js";
import { read } from "./rest.js";
import { keepOpen } from "./socket.js";
import { clearTrail, live, publish } from "./ticks.js";

/** No telemetry for this long on an open connection counts as a lost one, ms. */
const SILENCE_MS = 2000;
/** Text follows the ticks at this pace: faster cannot be read, ms. */
const TEXT_MS = 125;
const EVENTS_KEPT = 200;

let lastText = 0;
let openedAt = 0;

export function connect() {
  const socket = keepOpen("/api/v1/telemetry?rate_Hz=30", { open: () => opened(socket), message: receive, lost });
  setInterval(() => watch(socket), 250);
  addEventListener("online", () => socket.retry());
  return socket;
}

async function opened(socket) {
  openedAt = performance.now();
  set({ connection: { status: "open", cause: "", retryAt: null } });
  try {
    await load();
  } catch (problem) {
    if (problem.status === 0) socket.abandon("the server does not answer");
    else say(`The page could not load everything: ${problem.message}`);
  }
}

function lost(cause, retryAt) {
  set({ connection: { status: "lost", cause, retryAt } });
}

function watch(socket) {
  if (get().connection.status !== "open") return;
  const silence = performance.now() - Math.max(live.receivedAt, openedAt);
  if (silence > SILENCE_MS) socket.abandon(`no telemetry for ${(silence / 1000).toFixed(1)} s`);
}

async function load() {
  loadRuns();
  loadStudies();
  const [rig, camera, controllers, trajectories, gaitSchema, selection, newest] = await Promise.all(
    ["/rig", "/camera", "/controllers", "/trajectories", "/gait", "/selection", "/runs?limit=1"].map(read),
  );
  set({ rig, camera, controllers, trajectories, gaitSchema, selection });
  showRunPath(newest.runs.find(({ state }) => state === "running")?.trajectory);
}

let rigAsked = 0;

/**
 * The rig's values, its file and its camera, which change when somebody changes the rig file. Each change is told
 * twice within a moment; an older answer never replaces a newer one.
 */
async function loadRig() {
  const own = (rigAsked += 1);
  const [rig, camera] = await Promise.all(["/rig", "/camera"].map(read));
  if (own === rigAsked) set({ rig, camera });
}

function receive(data) {
  const message = JSON.parse(data);
  handlers[message.type]?.(message);
}

const handlers = {
  tick(tick) {
    publish(tick);
    const shown = get().tick;
    const now = performance.now();
    if (shown && shown.rig === tick.rig && shown.reason === tick.reason && now - lastText < TEXT_MS) return;
    lastText = now;
    set({ tick });
  },
  run(message) {
    const { event, run } = message;
    if (event === "started") clearTrail();
    if (event === "started" || event === "changed") showRunPath(run.trajectory);
    // A run that ends is told by the state that it has ended in; what else happens to runs concerns no path.
    else if (event === run?.state) showRunPath(null);
    hearOfRun(message);
    reloadIfInspected(message);
    endIfReplayed(message);
  },
  study: hearOfStudy,
  event(event) {
    set({ events: [event, ...get().events].slice(0, EVENTS_KEPT) });
  },
  rig(message) {
    if (message.selection && !hasUnsentEdits()) set({ selection: message.selection });
    if (message.settings || message.file) loadRig().catch((problem) => say(problem.message));
  },
};
