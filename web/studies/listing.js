/**
 * The studies that the page lists, and the one that is open. Asked again when somebody says that a study has
 * changed, at most once a second; a late answer never replaces a newer one.
 */
import { post, Problem, read, remove } from "../live/rest.js";
import { get, set, useStore } from "../store.js";

/** A batch finishes many runs a second: so often is the page drawn anew, ms. */
const REFRESH_MS = 1000;

const EMPTY = {
  /** Newest first, null until the first answer. */
  studies: null, error: "",
  /** Id of the open one, what is known of it, and what went wrong with it. */
  open: null, study: null, trouble: "", working: "",
  /** What its figures show. */
  metric: "normalized_mean_error",
};

export const now = () => get().studies ?? EMPTY;
export const change = (part) => set({ studies: { ...now(), ...part } });
/** A study has the rig for itself: its runs are changed by nobody. */
export const isOccupied = (state) => (state.studies?.studies ?? []).some(({ on, state: standing }) => on === "rig" && standing === "running");

export const useStudies = (select) => useStore((state) => select(state.studies ?? EMPTY));

const path = (id) => `/studies/${encodeURIComponent(id)}`;

let asked = 0;

/** One question at a time counts. */
async function ask() {
  const own = (asked += 1);
  try {
    const { studies } = await read("/studies");
    if (own === asked) change({ studies, error: "" });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    // A silent server is the connection's story, and the list is asked for again when it is back.
    if (own === asked) change({ error: problem.status === 0 ? "" : problem.message });
  }
}

let looked = 0;

async function look() {
  const { open, metric } = now();
  if (open === null) return;
  const own = (looked += 1);
  try {
    const study = await read(`${path(open)}?metric=${metric}`);
    if (own === looked && now().open === open) change({ study, trouble: "" });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (own !== looked || now().open !== open || problem.status === 0) return;
    if (problem.status === 404) closeStudy();
    else change({ trouble: problem.message });
  }
}

/** When the page comes to know its server, or knows it again. */
export const loadStudies = () => Promise.all([ask(), look()]);

let resting = 0;
let heard = false;

/** Asked at once, and then not again for a second, whatever is heard meanwhile. */
function refresh() {
  heard = Boolean(resting);
  if (heard) return;
  loadStudies();
  resting = setTimeout(rested, REFRESH_MS);
}

function rested() {
  resting = 0;
  if (heard) refresh();
}

/** A run of a study has finished, or the study itself has begun, ended or gone: {id, name, state, done, …}. */
export function hearOfStudy({ event, study }) {
  const { studies } = now();
  if (event === "deleted" && now().open === study.id) closeStudy();
  if (studies !== null && study?.id) change({ studies: withNews(studies, event, study) });
  refresh();
}

function withNews(studies, event, study) {
  if (event === "deleted") return studies.filter(({ id }) => id !== study.id);
  return studies.map((other) => (other.id === study.id ? { ...other, ...study } : other));
}

export function openStudy(id) {
  change({ open: id, study: null, trouble: "" });
  return look();
}

/** The focus goes back to the study's row. */
export function closeStudy() {
  const id = now().open;
  change({ open: null, study: null, trouble: "" });
  requestAnimationFrame(() => document.getElementById(rowId(id))?.focus());
}

export const rowId = (id) => `study-${id}`;

export function showMetric(metric) {
  change({ metric });
  return look();
}

/** Does one thing with the open study; what went wrong stays beside the buttons. @returns whether it was done */
async function doing(words, call) {
  if (now().working) return false;
  change({ working: words, trouble: "" });
  try {
    await call();
    return true;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ trouble: problem.message });
    return false;
  } finally {
    change({ working: "" });
  }
}

export const stopStudy = (id) => doing("Stopping", async () => change({ study: merged(await post(`${path(id)}/stop`)) }));
/** consent: to current through the coils of a real rig. */
export const resumeStudy = (id, consent = false) =>
  doing("Resuming", async () => change({ study: merged(await post(`${path(id)}/resume`, { consent })) }));

const merged = (answer) => (now().study?.id === answer.id ? { ...now().study, ...answer } : now().study);

/** @returns whether it is gone */
export async function deleteStudy(id) {
  const gone = await doing("Deleting", () => remove(path(id)));
  if (gone) {
    change({ studies: (now().studies ?? []).filter((study) => study.id !== id) });
    closeStudy();
  }
  return gone;
}
