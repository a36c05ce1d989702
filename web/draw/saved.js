/** Saved paths: they stand among the trajectories, and stay there when the server is started again. */
import { loadTrajectories } from "../live/loading.js";
import { patch, post, Problem, read, remove } from "../live/rest.js";
import { select } from "../live/selection.js";
import { get, say, useStore } from "../store.js";
import { change, edit, parameters } from "./drawing.js";

/** Names of all saved paths. @returns {string[]} */
export const useSaved = () => {
  const trajectories = useStore((state) => state.trajectories);
  return trajectories.filter(({ saved }) => saved).map(({ name }) => name);
};

/** "path 3": the first of these names that is free. */
export function freeName() {
  const taken = new Set(get().trajectories.map(({ name }) => name));
  let number = 1;
  while (taken.has(`path ${number}`)) number += 1;
  return `path ${number}`;
}

const url = (name) => `/trajectories/${encodeURIComponent(name)}`;

/**
 * @param {() => Promise<void>} work
 * @returns {Promise<string>} why it was refused, in words; "" when it was done
 */
async function trying(work) {
  try {
    await work();
    return "";
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    return problem.message;
  }
}

/** @param {string} name */
export const savePath = (name) =>
  trying(async () => {
    const { speed_mm_s } = await post("/trajectories", { name, ...parameters() });
    await loadTrajectories();
    select({ trajectory: { name, parameters: { speed_mm_s } } });
    change({ done: `Saved and selected as “${name}”.` });
  });

/** @param {string} name @param {string} next */
export const renamePath = (name, next) =>
  trying(async () => {
    await patch(url(name), { name: next });
    await loadTrajectories();
  });

/** The path as it can be saved again. @param {string} name @param {(path: object) => void} gone */
export const deletePath = (name, gone) =>
  trying(async () => {
    gone(await remove(url(name)));
    await loadTrajectories();
  });

/** @param {object} path as `deletePath` gave it */
export const restorePath = (path) =>
  trying(async () => {
    await post("/trajectories", path);
    await loadTrajectories();
  });

/** Onto the drawing board; what was there can be had back by Undo. @param {string} name */
export const openPath = (name) =>
  trying(async () => {
    const { points_mm: points, closed, kind } = await read(url(name));
    edit({ points, closed, kind }, -1);
    change({ way: "points" });
  });

/** The points of a file, CSV or JSON. @param {File} file */
export async function importFile(file) {
  const refused = await trying(async () => {
    const { points_mm: points } = await post("/trajectories/points", { text: await file.text() });
    edit({ points, closed: false, kind: "spline" }, -1);
    change({ way: "points" });
  });
  if (refused) say(`${file.name}: ${refused}`);
}
