/** Whether this browser has seen the tour; a browser that keeps nothing is not asked again and again in one visit. */

const KEY = "pivotrig.tour";
const DONE = "done";

export function isSeen() {
  try {
    return localStorage.getItem(KEY) === DONE;
  } catch {
    // Storage is not allowed: who cannot be remembered is not bothered.
    return true;
  }
}

export function remember() {
  try {
    localStorage.setItem(KEY, DONE);
  } catch {
    // Storage is not allowed.
  }
}
