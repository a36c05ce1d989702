/** The event log as the page knows it: what the server has told so far, and how far back somebody has looked. */
import { Problem, read } from "../live/rest.js";
import { get, set, useStore } from "../store.js";
import { joined } from "./words.js";

const PAGE = 200;
/** Lines that are kept at most: what is older is asked for again. */
const MOST = 3000;

export const useLog = (select) => useStore((state) => select(state.log));
const change = (part) => set({ log: { ...get().log, ...part } });

let turn = 0;

/** The newest page, when the page opens, comes back, or has missed something. */
export async function loadEvents() {
  const own = (turn += 1);
  try {
    const { events, next } = await read(`/events?limit=${PAGE}`);
    if (own !== turn) return;
    const newest = events[0]?.number ?? 0;
    // What has come over the stream while the answer was on its way.
    const known = get().events.filter(({ number }) => number > newest);
    set({ events: joined(known, events), log: { ...get().log, next, error: "", loaded: true, seen: seenAfter(newest) } });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (own === turn) change({ error: problem.message });
  }
}

/** Another session of the server: nothing of the one before counts any more. */
export function beginLogAnew() {
  set({ events: [], log: { ...get().log, next: null, seen: 0 } });
  loadEvents();
}

/** What was there before this page counts as seen. */
function seenAfter(newest) {
  const { loaded, seen } = get().log;
  return loaded ? seen : newest;
}

/** @param {any} message an event, as the telemetry stream tells it */
export function hearOfEvent(message) {
  const { type: _, ...event } = message;
  const { events } = get();
  const newest = events[0]?.number ?? event.number - 1;
  if (event.number <= newest) return;
  const kept = [event, ...events];
  set({ events: kept.slice(0, MOST) });
  if (kept.length > MOST) change({ next: kept[MOST - 1].number });
  if (event.number > newest + 1) loadEvents();
}

export async function loadOlder() {
  const { next, loading } = get().log;
  if (next === null || loading) return;
  change({ loading: true });
  try {
    const page = await read(`/events?limit=${PAGE}&cursor=${next}`);
    set({ events: joined(get().events, page.events) });
    change({ next: page.next, error: "" });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ error: problem.message });
  } finally {
    change({ loading: false });
  }
}

/** Back to the beginning of the session. */
export async function loadAll() {
  while (get().log.next !== null && get().log.error === "") await loadOlder();
}

export const show = (severity) => change({ severity });
export const search = (text) => change({ text });

/** Somebody looks at the log. */
export function seeAll() {
  const newest = get().events[0]?.number ?? 0;
  if (newest > get().log.seen) change({ seen: newest });
}
