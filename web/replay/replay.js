/** Opens recordings in the page, in place of the rig, and gives the page back to the rig. */
import { closeSetup } from "../calibration/setup.js";
import { Problem, read } from "../live/rest.js";
import { SHEET } from "../runs/sheet.js";
import { get, say, set, useStore } from "../store.js";
import { goTo, idsInAddress, leaveQuietly, MOST, onAddress } from "./address.js";
import { closeLine, openLine } from "./line.js";
import { pause, play, restart } from "./player.js";
import { recordingOf } from "./recording.js";

/**
 * What the store knows of an open replay.
 * @type {import("../types").Replay}
 */
const OPENING = {
  ids: [],
  /** "loading" | "open" | "lost", with the cause in words; what the server calls this replay, for the scene. */
  status: "loading", cause: "", session: null,
  /** One a run (recording.js), empty while they load; the longest of their durations, s. */
  runs: [], duration_s: 0,
  playing: false, speed: 1,
  /** [from, to] in s: what is played again and again, and what the charts show; null: the whole run. */
  loop: null, zoom: null,
  /** The curves of what the charts show, one a run, where the whole run's are too coarse for it (closer.js). */
  closer: null,
  /** A second look at the pictures of the one run (retracked.js). */
  second: null,
};

export const useReplay = (select) => useStore((state) => (state.replay ? select(state.replay) : null));

/** Shows one recorded run, or two side by side, in place of the rig. @param ids of one or two runs */
export function openReplay(ids) {
  const wanted = [...new Set(ids)].slice(0, MOST);
  goTo(wanted);
  follow();
}

/** Back to the rig. */
export function closeReplay() {
  goTo([]);
  follow();
}

/** The address decides what is shown. */
export function followAddress() {
  onAddress(follow);
  follow();
}

function follow() {
  const ids = idsInAddress();
  if (same(ids, get().replay?.ids ?? [])) return;
  end();
  if (ids.length > 0) begin(ids);
}

const same = (some, others) => some.length === others.length && some.every((id, index) => id === others[index]);

function end() {
  pause();
  closeLine();
  set({ replay: null });
}

async function begin(ids) {
  closeSetup();
  // It would cover what is asked for.
  if (SHEET.matches) set({ inspected: null });
  scrollTo({ top: 0 });
  const opening = { ...OPENING, ids };
  set({ replay: opening });
  try {
    const runs = await Promise.all(ids.map(load));
    if (get().replay === opening) start(opening, runs);
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (get().replay === opening) giveUp(problem.message);
  }
}

async function load(id) {
  const path = `/runs/${encodeURIComponent(id)}`;
  const [run, overview] = await Promise.all([read(path), read(`${path}/overview`)]);
  return recordingOf(run, overview);
}

function start(opening, runs) {
  const duration_s = Math.max(...runs.map((run) => run.duration_s));
  set({ replay: { ...opening, runs, duration_s } });
  restart();
  openLine(opening.ids, giveUp);
  play();
}

/** Somebody has deleted a run: it cannot be shown any longer. */
export function endIfReplayed({ event, run }) {
  if (event === "deleted") endWithout(run.id);
}

/** What happened while there was no connection was told to nobody. */
export async function endIfGone() {
  for (const { id } of get().replay?.runs ?? []) {
    const isGone = await read(`/runs/${encodeURIComponent(id)}`).then(() => false, ({ status }) => status === 404);
    if (isGone) endWithout(id);
  }
}

function endWithout(id) {
  if (get().replay?.ids.includes(id)) giveUp(`the run ${id} was deleted.`);
}

function giveUp(cause) {
  say(`The recording cannot be shown: ${cause}`);
  leaveQuietly();
  end();
}
