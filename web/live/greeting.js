/** The server says who it is with its first words: another start of it, or another version than this page is of. */
import { beginLogAnew } from "../log/listing.js";
import { know } from "../operator/lease.js";
import { get, say, set } from "../store.js";
import { createLateness } from "./lateness.js";
import { clearTrail } from "./ticks.js";

/** Modules come from /static/VERSION/…: the files that this page was made from. */
const OWN = new URL(import.meta.url).pathname.split("/")[2];

const RESTARTED =
  "pivotrig was restarted. What had been going on has ended: nothing is armed, and nothing was done again by itself.";

/** Which start of the server this page has spoken to last. */
let start = "";
let lateness = createLateness();

/** @param {{start: string, page: string, you: string, you_may: import("../types").Operator["you_may"]}} message */
export function greet(message) {
  lateness = createLateness();
  set({ outdated: message.page !== OWN });
  if (start !== "" && start !== message.start) {
    clearTrail();
    beginLogAnew();
    set({ busy: null });
    say(RESTARTED, "info");
  }
  start = message.start;
  know({ you: message.you, you_may: message.you_may });
}

/** The server's time with every few ticks: whatever is late comes after it. @param {{server_s: number}} message */
export function hearClock({ server_s }) {
  const late_ms = Math.round(lateness(server_s * 1000, performance.now()));
  const { connection } = get();
  if (connection.status !== "open" || !(isSlow(late_ms) || isSlow(connection.late_ms))) return;
  set({ connection: { ...connection, late_ms } });
}

/** Later than a person takes for at once, ms. */
const SLOW_MS = 1000;

/** @param {number} late_ms */
export const isSlow = (late_ms) => late_ms > SLOW_MS;
