/** Faults of the simulated rig: what there is, what is in, put in, take away. The list in the store is the server's. */
import { post, Problem, read, remove } from "../live/rest.js";
import { get, say, set } from "../store.js";

const PLACE = "/simulation/faults";

let asked = 0;

/** Reads the list again; an older answer never replaces a newer one. A real rig has none. */
export async function loadFaults() {
  const own = (asked += 1);
  try {
    const { faults } = await read(PLACE);
    if (own === asked) set({ faults });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (problem.status === 404) set({ faults: null });
    else if (problem.status !== 0) say(problem.message);
  }
}

/**
 * @param {string} name
 * @param {{parameters?: Record<string, any>, duration_s?: number | null, intermittent?: {on_s: number, off_s: number} | null}} how
 * @returns {Promise<Problem | null>} why it was refused
 */
export function putIn(name, { parameters = {}, duration_s = null, intermittent = null }) {
  return change(() => post(PLACE, { name, parameters, duration_s, intermittent }));
}

export const takeAway = (name) => change(() => remove(`${PLACE}/${name}`));
export const takeAllAway = () => change(() => remove(PLACE));

async function change(call) {
  try {
    await call();
    return null;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (Object.keys(problem.fields).length === 0) say(problem.message);
    return problem;
  } finally {
    await loadFaults();
  }
}

/** How many are in; 0 on a real rig. */
export const countIn = ({ faults }) => (faults ?? []).filter(({ injected }) => injected !== null).length;

export const isWatching = ({ faults }) => (faults ?? []).some(({ reaction }) => reaction?.verdict === "watching");

export const usualOf = (fault) => ({ ...defaults(fault.parameters), ...fault.promise.parameters });

const defaults = (schema) =>
  Object.fromEntries(Object.entries(schema.properties ?? {}).map(([name, { default: value }]) => [name, value]));

export const faultNamed = (name) => (get().faults ?? []).find((fault) => fault.name === name);
