/** What each message of the telemetry stream means to the page. */
import { hearOfEvent } from "../log/listing.js";
import { loadFaults } from "../faults/catalogue.js";
import { endIfReplayed } from "../replay/replay.js";
import { tellIfAway } from "../notify/device.js";
import { reloadIfInspected } from "../runs/inspected.js";
import { hearOfRun } from "../runs/listing.js";
import { hearOfOperator } from "../operator/lease.js";
import { get, say, set } from "../store.js";
import { hearOfStudy } from "../studies/listing.js";
import { greet, hearClock } from "./greeting.js";
import { follow, loadRig, loadTrajectories } from "./loading.js";
import { hearOfSelection } from "./selection.js";
import { clearTrail, mark, publish } from "./ticks.js";

/** Text follows the ticks at this pace: faster cannot be read, ms. */
const TEXT_MS = 125;

/** How an event is shown on the charts, by its severity. @type {Record<string, "warn" | "fault">} */
const MARKS = { warn: "warn", error: "fault", fault: "fault" };

let lastText = 0;

/** @param {string} data */
export function receive(data) {
  const message = JSON.parse(data);
  handlers[message.type]?.(message);
  tellIfAway(message);
}

/** @param {Error} problem */
const complain = (problem) => say(problem.message);

/** @type {Record<string, (message: any) => void>} */
const handlers = {
  server: greet,
  clock: hearClock,
  operator: hearOfOperator,
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
    if (event === "started" || event === "changed") follow(run);
    // A run that ends is told by the state that it has ended in; what else happens to runs concerns no path.
    else if (event === run?.state) follow(null);
    hearOfRun(message);
    reloadIfInspected(message);
    endIfReplayed(message);
  },
  study: hearOfStudy,
  event(event) {
    mark(event.time_s, MARKS[event.severity] ?? "info", event.message);
    hearOfEvent(event);
    if (event.code === "injected") loadFaults();
  },
  rig(message) {
    if (message.selection) hearOfSelection(message.selection, message.by);
    if (message.trajectories) loadTrajectories().catch(complain);
    if (message.settings || message.file) loadRig().catch(complain);
  },
};
