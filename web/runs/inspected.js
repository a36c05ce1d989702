/** The run whose details are open, and what is done with it; what went wrong stays beside the buttons. */
import { patch, post, Problem, read, remove } from "../live/rest.js";
import { amend, get, say, set, useStore } from "../store.js";
import { dropRuns, takeIn } from "./listing.js";

/** A run that has just ended gets its last figures within this time, ms. */
const RELOAD_PAUSE_MS = 300;

const NOTHING = { run: null, error: "", working: "", restarted: null };

const now = () => get().inspected;
/** @param {Partial<import("../types").Inspected>} part */
const change = (part) => amend("inspected", part);

/** The details with the newest that the list knows of the run; null while none is open. */
export const useInspected = () =>
  useStore(({ inspected, listing }) => {
    if (!inspected) return null;
    const row = listing?.runs?.find(({ id }) => id === inspected.id);
    return { ...inspected, row: row ?? null };
  });

export const wholeRun = ({ run, row }) => (run || row ? { ...run, ...row } : null);

export function inspect(id) {
  if (now()?.id === id) return;
  set({ inspected: { ...NOTHING, id } });
  load(id);
}

export const toggleDetails = (id) => (now()?.id === id ? closeDetails() : inspect(id));

/** The focus goes back to the run's row. */
export function closeDetails() {
  const id = now()?.id;
  set({ inspected: null });
  requestAnimationFrame(() => document.getElementById(rowId(id))?.focus());
}

export const rowId = (id) => `run-${id}`;

async function load(id) {
  try {
    const run = await read(`/runs/${encodeURIComponent(id)}`);
    if (now()?.id === id) change({ run });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (now()?.id === id) change({ error: problem.message });
  }
}

let reloading = 0;

/** Somebody says that a run has changed. */
export function reloadIfInspected({ event, run }) {
  if (!run?.id || run.id !== now()?.id) return;
  clearTimeout(reloading);
  if (event === "deleted") closeDetails();
  else reloading = setTimeout(() => load(run.id), RELOAD_PAUSE_MS);
}

/** Does one thing with the open run and says so meanwhile. @returns the answer, or null when it was refused */
async function doing(words, call) {
  if (now()?.working !== "") return null;
  change({ working: words, error: "" });
  try {
    return (await call()) ?? true;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ error: problem.message });
    return null;
  } finally {
    change({ working: "" });
  }
}

/** Changes label, tags, notes or the pin; more: of the request. Raises Problem. */
export async function edit(id, part, more = {}) {
  const run = await patch(`/runs/${encodeURIComponent(id)}`, part, more);
  takeIn({ id, ...part, ...run });
  if (now()?.id === id) change({ run: { ...now()?.run, ...part, ...run } });
}

export const pin = ({ id, pinned }) => doing(pinned ? "Unpinning" : "Pinning", () => edit(id, { pinned: !pinned }));

/** From the list, where there is no place for what went wrong. */
export const pinInList = ({ id, pinned }) => edit(id, { pinned: !pinned }).catch((problem) => say(problem.message));

/** @returns whether it has begun */
export async function runAgain({ id }) {
  const answer = await doing("Starting", () => post(`/runs/${encodeURIComponent(id)}/again`));
  if (answer !== null && now()?.id === id) change({ restarted: answer });
  return answer !== null;
}

/** Deletes one after the other. @returns what was refused, in words: ["eight: …"] */
export async function deleteRuns(runs, nameOf) {
  const gone = [];
  const refused = [];
  for (const run of runs) {
    try {
      await remove(`/runs/${encodeURIComponent(run.id)}`);
      gone.push(run.id);
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      refused.push(`${nameOf(run)}: ${problem.message}`);
    }
  }
  dropRuns(gone);
  if (gone.includes(now()?.id)) set({ inspected: null });
  return refused;
}
