/** The path that is being drawn: what is done to it lands in the store's `drawing`, and can be undone. */
import { post, Problem } from "../live/rest.js";
import { select } from "../live/selection.js";
import { get, set, useStore } from "../store.js";
import { begun, did, redone, undone } from "./history.js";
import { isPath, NOTHING, parametersOf, removed } from "./shape.js";

/**
 * @typedef {import("./shape.js").Shape} Shape
 * @typedef {object} Drawing
 * @property {"freehand" | "points"} way
 * @property {import("./history.js").History<Shape>} history
 * @property {number} chosen index of the point that was touched last, -1 for none
 * @property {import("../types").Path | null} preview as the server would have it walked; null while that is not known
 * @property {string} refusal why it cannot be walked, in words
 * @property {string} done what has become of it, in words
 */

/** The speed of waypoints where the selection has none, mm/s. */
const SPEED_MM_S = 3;

/** @type {Drawing} */
const EMPTY = { way: "freehand", history: begun(NOTHING), chosen: -1, preview: null, refusal: "", done: "" };

/** @returns {Drawing} */
export const drawing = () => get().drawing ?? EMPTY;

/** @template T @param {(drawing: Drawing) => T} part @returns {T} */
export const useDrawing = (part) => useStore((state) => part(state.drawing ?? EMPTY));

/** @param {Partial<Drawing>} part */
export const change = (part) => set({ drawing: { ...drawing(), ...part } });

export const shape = () => drawing().history.now;

/** @param {import("./history.js").History<Shape>} history @param {number} chosen */
function take(history, chosen = drawing().chosen) {
  change({ history, chosen: Math.min(chosen, history.now.points.length - 1), done: "" });
  askPreview();
}

/** One step, to be undone as one. @param {Shape} next @param {number} [chosen] */
export const edit = (next, chosen) => take(did(drawing().history, next), chosen);

/** Goes on with the newest step, as while a point is dragged. @param {Shape} next */
export const goOn = (next) => take({ ...drawing().history, now: next });

/** As if it had never begun. @param {import("./history.js").History<Shape>} history */
export const restore = (history) => take(history);

export const undo = () => take(undone(drawing().history));
export const redo = () => take(redone(drawing().history));
export const clear = () => edit({ ...shape(), points: [] }, -1);

/** @param {number} index */
export const removePoint = (index) => index >= 0 && edit(removed(shape(), index), -1);

const speed = () => get().selection?.trajectory.parameters.speed_mm_s ?? SPEED_MM_S;

/** What the server takes as a path. */
export const parameters = () => parametersOf(shape(), speed());

/** The next run walks it. */
export function usePath() {
  select({ trajectory: { name: "waypoints", parameters: parameters() } });
  change({ done: "Selected: the next run walks it." });
}

let asking = false;
let changed = false;

/** The server's own curve through the points; one question at a time, and the newest counts. */
async function askPreview() {
  changed = true;
  if (asking) return;
  asking = true;
  while (changed) {
    changed = false;
    const answer = isPath(shape()) ? await preview() : { preview: null, refusal: "" };
    if (get().drawing) change(answer);
  }
  asking = false;
}

/** @returns {Promise<{preview: any, refusal: string}>} */
async function preview() {
  try {
    return { preview: await post("/trajectories/preview", { name: "waypoints", parameters: parameters() }), refusal: "" };
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    return { preview: null, refusal: problem.message.replace(/^[\w., ]+: /, "") };
  }
}
