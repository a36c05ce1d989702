/** Keeps the telemetry stream open and says at any time how far what is shown can be believed. */
import { get, say, set } from "../store.js";
import { CLIENT, keepOverReload } from "./client.js";
import { keepBeating } from "./heartbeat.js";
import { load } from "./loading.js";
import { receive } from "./messages.js";
import { giveUpWaiting, read } from "./rest.js";
import { keepOpen } from "./socket.js";
import { live } from "./ticks.js";

/** Ticks come every 33 ms; without one for this long what is shown is old, ms... */
const SILENT_MS = 700;
/** ...and for this long, an open connection counts as a lost one, ms. */
const LOST_MS = 2000;
const LOOK_MS = 250;

const OPEN = { status: /** @type {const} */ ("open"), cause: "", retryAt: null, late_ms: 0 };

let openedAt = 0;

/** @typedef {{retry: () => void, abandon: (cause: string) => void}} Line */

export function connect() {
  keepOverReload();
  const socket = keepOpen(`/api/v1/telemetry?rate_Hz=30&client=${CLIENT}`, { open: () => opened(socket, beat), message: receive, lost });
  const beat = keepBeating(socket.send);
  const look = () => watch(socket);
  setInterval(look, LOOK_MS);
  addEventListener("online", () => socket.retry());
  // A page that was asleep looks before it shows anything.
  document.addEventListener("visibilitychange", look);
  document.addEventListener("resume", look);
  addEventListener("pageshow", look);
  return socket;
}

/** @param {Line} socket @param {() => void} beat */
async function opened(socket, beat) {
  openedAt = performance.now();
  beat();
  set({ connection: OPEN });
  try {
    await load();
  } catch (caught) {
    const problem = /** @type {import("./rest.js").Problem} */ (caught);
    if (problem.status === 0) socket.abandon("the server does not answer");
    else say(`The page could not load everything: ${problem.message}`);
  }
}

/** @param {string} cause @param {number} retryAt performance.now() of the next try, ms */
function lost(cause, retryAt) {
  giveUpWaiting();
  set({ connection: { status: "lost", cause, retryAt, late_ms: 0 } });
  // A stream that is refused says not why; any other answer does (operator/refusals.js).
  read("/operator").catch(() => {});
}

const silence = () => performance.now() - Math.max(live.receivedAt, openedAt);

/** @param {Line} socket */
function watch(socket) {
  const { connection } = get();
  if (connection.status !== "open" && connection.status !== "silent") return;
  const silent = silence();
  const cause = `no telemetry for ${(silent / 1000).toFixed(1)} s`;
  if (silent > LOST_MS) socket.abandon(cause);
  else if (silent > SILENT_MS) set({ connection: { ...connection, status: "silent", cause } });
  else if (connection.status === "silent") set({ connection: OPEN });
}
