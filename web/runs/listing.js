/**
 * The runs that the page lists: which ones are asked for, those that have come, and those that are ticked.
 * Asked again only when somebody says that a run has changed; a late answer never replaces a newer one.
 */
import { Problem, read } from "../live/rest.js";
import { get, set, useStore } from "../store.js";

const PAGE = 50;
/** Several changes within this time are one question, ms. */
const REFRESH_PAUSE_MS = 200;
/** A recording is finished about a second after its run; meanwhile the list looks again at this pace, ms. */
const UNFINISHED_PAUSE_MS = 1000;
const UNFINISHED_LOOKS = 30;
const TYPING_PAUSE_MS = 250;

export const NO_FILTER = { text: "", state: "", controller: "", trajectory: "", tag: "", pinned: "", simulated: "", study: "" };

const EMPTY = {
  filter: NO_FILTER,
  /** Newest first, null until the first answer; next: cursor of the following page or null. */
  runs: null, next: null,
  /** How many the filter finds, and what all runs take: {runs, bytes, pinned_bytes, free_bytes}. */
  total: null, totals: null,
  loading: false, error: "",
  /** Ids of the ticked runs, in the order of ticking. */
  ticked: [],
};

const now = () => get().listing ?? EMPTY;
const change = (part) => set({ listing: { ...now(), ...part } });

export const useListing = (select) => useStore((state) => select(state.listing ?? EMPTY));

export const isFiltered = (filter) => Object.values(filter).some(Boolean);

function address(cursor = null) {
  const asked = Object.entries(now().filter).filter(([, value]) => value !== "");
  const query = new URLSearchParams([...asked, ["limit", String(PAGE)], ...(cursor ? [["cursor", cursor]] : [])]);
  return `/runs?${query}`;
}

let asked = 0;

/** One question at a time counts: `take` gets the answer unless another question was asked meanwhile. */
async function ask(cursor, take) {
  const own = (asked += 1);
  change({ loading: true });
  try {
    const answer = await read(address(cursor));
    if (own !== asked) return;
    change({ loading: false, error: "", ...take(answer) });
    lookAgainIfUnfinished();
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    // A silent server is the connection's story, and the list is asked for again when it is back.
    if (own === asked) change({ loading: false, error: problem.status === 0 ? "" : problem.message });
  }
}

const counts = ({ total = null, totals = null }) => ({ total, totals });

/** The first page of what the filter asks for. */
export const search = () => ask(null, (answer) => ({ runs: answer.runs, next: answer.next, ...counts(answer) }));

export function more() {
  const { next, loading } = now();
  if (next === null || loading) return undefined;
  return ask(next, (answer) => ({ runs: joined(now().runs, answer.runs), next: answer.next, ...counts(answer) }));
}

function joined(runs, further) {
  const known = new Set(runs.map(({ id }) => id));
  return [...runs, ...further.filter(({ id }) => !known.has(id))];
}

let typing = 0;

export function filterBy(part) {
  change({ filter: { ...now().filter, ...part }, ticked: [] });
  clearTimeout(typing);
  typing = setTimeout(search, "text" in part || "tag" in part ? TYPING_PAUSE_MS : 0);
}

/** Many runs have come or gone: what was loaded beyond the newest page is not to be trusted. */
let isStale = false;

/** The newest page once more, with what was loaded beyond it kept. */
const refresh = () =>
  ask(null, (answer) => {
    const tail = answer.next === null || isStale ? [] : beyond(now().runs ?? [], answer.runs.at(-1));
    isStale = false;
    return { runs: [...answer.runs, ...tail], next: tail.length > 0 ? now().next : answer.next, ...counts(answer) };
  });

/** When the page comes to know its server, or knows it again. */
export const loadRuns = () => (now().runs === null ? search() : refresh());

const orderOf = ({ started_at, id }) => `${started_at} ${id}`;
const beyond = (runs, last) => runs.filter((run) => orderOf(run) < orderOf(last));

let waiting = 0;

/** Once the answer under way has come: a question for more is not to be lost. */
function refreshSoon(pause = REFRESH_PAUSE_MS) {
  clearTimeout(waiting);
  waiting = setTimeout(() => (now().loading ? refreshSoon() : refresh()), pause);
}

const isUnfinished = (run) => run.state !== "running" && run.recording?.state === "writing";

let looks = 0;

function lookAgainIfUnfinished() {
  if (!now().runs?.some(isUnfinished)) return;
  looks += 1;
  if (looks <= UNFINISHED_LOOKS) refreshSoon(UNFINISHED_PAUSE_MS);
}

/** A run has started, changed, ended or gone: its row follows at once, the rest of the list a moment later. */
export function hearOfRun({ event, run }) {
  const { runs, filter } = now();
  looks = 0;
  isStale ||= !run?.id;
  if (run?.id && runs !== null) change({ runs: withNews(runs, event, run, isFiltered(filter)) });
  refreshSoon();
}

function withNews(runs, event, run, filtered) {
  if (event === "deleted") return runs.filter(({ id }) => id !== run.id);
  if (runs.some(({ id }) => id === run.id)) return runs.map((other) => (other.id === run.id ? { ...other, ...run } : other));
  return event === "started" && !filtered ? [run, ...runs] : runs;
}

/** What the server has answered about one run. */
export function takeIn(run) {
  change({ runs: (now().runs ?? []).map((other) => (other.id === run.id ? { ...other, ...run } : other)) });
}

export function dropRuns(ids) {
  const stays = (id) => !ids.includes(id);
  change({ runs: (now().runs ?? []).filter(({ id }) => stays(id)), ticked: now().ticked.filter(stays) });
  refreshSoon();
}

export function tick(id, on) {
  const others = now().ticked.filter((other) => other !== id);
  change({ ticked: on ? [...others, id] : others });
}

export const untickAll = () => change({ ticked: [] });

/** In the order of ticking, as far as they are listed. */
export const tickedRuns = ({ runs, ticked }) => ticked.map((id) => runs?.find((run) => run.id === id)).filter(Boolean);
