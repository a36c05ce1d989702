/** Which parts of the scene this browser shows. Pure but for the browser's memory, which may be forbidden. */

/** As the server calls them, and as people do. @type {[string, string, string][]} */
export const LAYERS = [
  ["field", "Field", "Arrows of the magnetic field: direction, and strength by length and colour"],
  ["coils", "Coils", "The three pairs of coils, to scale"],
  ["reference", "Path", "The path that is selected or walked, and where on it the robot should be"],
  ["trail", "Trail", "Where the robot was in the last minute"],
  ["camera", "Camera", "The camera's picture laid on the plate, and what it sees from where"],
];
const NAMES = LAYERS.map(([name]) => name);
/** The camera's picture costs some 150 kB a second. */
export const AT_FIRST = NAMES.filter((name) => name !== "camera");
const KEY = "pivotrig.scene.layers";

/** @param {string[]} shown @param {string} name @returns {string[]} in the order of the list */
export const toggled = (shown, name) => NAMES.filter((each) => shown.includes(each) !== (each === name));

/** What was remembered, as far as it is understood. @param {string | null} text @returns {string[]} */
export function understood(text) {
  try {
    const found = JSON.parse(text ?? "null");
    return Array.isArray(found) ? NAMES.filter((name) => found.includes(name)) : AT_FIRST;
  } catch {
    return AT_FIRST;
  }
}

export function remembered() {
  try {
    return understood(localStorage.getItem(KEY));
  } catch {
    return AT_FIRST;
  }
}

/** @param {string[]} shown */
export function remember(shown) {
  try {
    localStorage.setItem(KEY, JSON.stringify(shown));
  } catch {
    // Without a memory the choice holds for this visit.
  }
}
