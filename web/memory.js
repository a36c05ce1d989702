/** What this browser keeps from one visit to the next. One that keeps nothing begins anew each time. */

const HEAD = "pivotrig.";

/** @param {string} name @returns {any} null when nothing is kept there, or nothing that can be read */
export function recalled(name) {
  try {
    return JSON.parse(localStorage.getItem(HEAD + name) ?? "null");
  } catch {
    return null;
  }
}

/** @param {string} name @param {unknown} value as JSON has it */
export function keep(name, value) {
  try {
    localStorage.setItem(HEAD + name, JSON.stringify(value));
  } catch {
    // It holds until the page is closed.
  }
}
