/** What somebody chose to see on the charts, in the store; the charts themselves are drawn apart from the page. */
import { live } from "../live/ticks.js";
import { get, set, useStore } from "../store.js";
import { rememberView } from "./remembered.js";
import { shownSpan, toggled } from "./span.js";

const listeners = new Set();

export const useView = () => useStore((state) => state.charts);
export const view = () => get().charts;

/** @returns {() => void} */
export function onView(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function changeView(change) {
  const changed = { ...view(), ...change };
  set({ charts: changed });
  rememberView(changed);
  for (const listener of listeners) listener();
}

/** @returns {[number, number]} what the charts of the rig show, in the rig's time, s */
export const span = () => shownSpan(view(), live.history.newest_s || 0);

export const togglePause = () => changeView(toggled(view(), live.history.newest_s || 0));
export const leaveZoom = () => changeView({ zoom: null });
/** Also out of a zoom: how far back one looks is chosen anew. */
export const lookBack = (window_s) => changeView({ window_s, held: null, zoom: null });

const without = (list, item) => list.filter((each) => each !== item);
const toggledIn = (list, item) => (list.includes(item) ? without(list, item) : [...list, item]);

/** @param {string} group of curves (charts/curves.js) */
export const toggleCurve = (group) => changeView({ hidden: toggledIn(view().hidden, group) });
/** @param {string} title of a chart */
export const toggleChart = (title) => changeView({ folded: toggledIn(view().folded, title) });
