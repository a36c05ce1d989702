/** The curves of a part of a run, closer than the whole run's: asked for when the charts look at little of it. */
import { Problem, read } from "../live/rest.js";
import { amend, get } from "../store.js";
import { columnsOf, indexAt } from "./recording.js";

/** With fewer values than this a chart shows corners that are not there. */
const FEW = 400;
/** Asked for beside the part on each side, as a share of it: the lines go on to the edge. */
const MARGIN = 0.02;

/** Loads what the charts show now; a late answer to an earlier part is let go. */
export async function lookCloser() {
  const { replay } = get();
  const zoom = replay?.zoom;
  if (!zoom || replay.runs.every((run) => isFine(run, zoom))) return;
  try {
    const closer = await Promise.all(replay.runs.map(({ id }) => load(id, zoom)));
    if (get().replay?.zoom === zoom) amend("replay", { closer });
  } catch (problem) {
    // The whole run's curves stay: coarse, but true.
    if (!(problem instanceof Problem)) throw problem;
  }
}

/** Whether a recording's own curves have all there is, or enough of it. */
function isFine({ series, ticks }, [from, to]) {
  const values = indexAt(series.time_s, to) - indexAt(series.time_s, from);
  return values >= FEW || series.time_s.length === ticks;
}

async function load(id, [from, to]) {
  const margin = MARGIN * (to - from);
  const query = new URLSearchParams({ start_s: String(Math.max(0, from - margin)), end_s: String(to + margin) });
  const { series } = await read(`/runs/${encodeURIComponent(id)}/series?${query}`);
  return columnsOf(series);
}
