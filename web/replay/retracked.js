/** A second look at the pictures of the run that is shown: asked for, watched, and put beside the first in the charts. */
import { post, Problem, read, remove } from "../live/rest.js";
import { amend, get } from "../store.js";
import { columnsOf } from "./recording.js";

/** From one question how far it is to the next, ms. */
const PERIOD_MS = 300;

const pathOf = (id) => `/runs/${encodeURIComponent(id)}/retrack`;

function isShown(id) {
  const ids = get().replay?.ids ?? [];
  return ids.length === 1 && ids[0] === id;
}

/** {stage: "working" | "done" | "failed" | "cancelled", progress, reason, comparison, series: columns of the charts} */
function tell(id, second) {
  if (isShown(id)) amend("replay", { second });
}

/** What is known of an earlier second look at this run. */
export async function findSecondLook(id) {
  try {
    await watch(id);
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
  }
}

/** @param body as POST /runs/{id}/retrack takes it; throws a Problem where that is refused */
export async function lookAgain(id, body) {
  await post(pathOf(id), body);
  tell(id, { stage: "working", progress: 0, reason: "", comparison: null, series: null });
  await watch(id);
}

export async function giveUp(id) {
  await remove(pathOf(id));
}

/** Away with the second curves. */
export async function forget(id) {
  tell(id, null);
  await remove(pathOf(id)).catch(() => {});
}

async function watch(id) {
  while (isShown(id)) {
    const answer = await read(pathOf(id));
    take(id, answer);
    if (answer.stage !== "working") return;
    await new Promise((resolve) => setTimeout(resolve, PERIOD_MS));
  }
}

function take(id, answer) {
  const series = answer.series ? columnsOf(answer.series) : null;
  tell(id, answer.stage === "none" ? null : { ...answer, series });
}
