/** Which of the journal's tabs is open; the page's address keeps it (`?tab=log`), so that a reload comes back to it. */
import { get, set, useStore } from "../store.js";
import { addressWith, tabIn } from "./tab_address.js";

export const useTab = () => useStore((state) => state.tab);

export function showTab(name) {
  if (get().tab === name) return;
  set({ tab: name });
  history.replaceState(history.state, "", addressWith(location.href, name));
}

/** The tab that the address names, once, when the page is opened. @param {string[]} names */
export function openTabOfAddress(names) {
  const named = tabIn(location.href, names);
  if (named !== null) set({ tab: named });
}
