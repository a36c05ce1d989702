/**
 * By which name the server knows this tab: it says who operates, so nobody else ever hears it (another one than PAGE_ID,
 * which all pages hear of). It outlives a reload. While the page is open it lies in no storage, from which a tab that is
 * duplicated would take it along.
 */
import { anyId } from "./page_id.js";

const PLACE = "pivotrig.client";

/** @returns {string | null} what the page before this one has left in the tab */
function taken() {
  try {
    const id = sessionStorage.getItem(PLACE);
    sessionStorage.removeItem(PLACE);
    return id;
  } catch {
    return null;
  }
}

function leave() {
  try {
    sessionStorage.setItem(PLACE, CLIENT);
  } catch {
    // The next page of this tab is another client.
  }
}

export const CLIENT = taken() ?? anyId();

export function keepOverReload() {
  addEventListener("pagehide", leave);
  addEventListener("pageshow", taken);
}
