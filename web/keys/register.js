/**
 * Keys that work on the whole page while the component that offers them is there. Pure: it knows no page.
 *
 * @typedef {object} Binding
 * @property {string | string[]} key as `KeyboardEvent.key` names it, letters small: "k", "arrowleft", ["+", "="]
 * @property {string} words what it does, for the sheet of keys
 * @property {(event: KeyboardEvent) => void} [act] left out: told of in the sheet, and heeded by somebody else
 * @property {(event: KeyboardEvent | null) => void} [release] the key is up again, or nobody would hear of it any more
 * @property {() => boolean} [when] it works just now; otherwise it is neither heeded nor shown
 * @property {boolean} [repeats] a key that is held down acts again and again
 *
 * @typedef {{group: string, list: () => Binding[]}} Offer
 */

/** @type {Set<Offer>} */
const offers = new Set();

/** @param {string} group @param {() => Binding[]} list asked at every key, so that it may change @returns {() => void} takes them away */
export function register(group, list) {
  const offer = { group, list };
  offers.add(offer);
  return () => offers.delete(offer);
}

/** @param {Binding} binding */
const works = (binding) => binding.when?.() ?? true;
/** @param {Binding} binding */
const namesOf = (binding) => [binding.key].flat();

/** The newest offer of a key counts: what has been opened last is in front. @param {KeyboardEvent} event @returns {Binding | null} */
export function bindingOf(event) {
  const lists = [...offers].reverse().map(({ list }) => list());
  return lists.flat().find((binding) => binding.act && fits(event, binding) && works(binding)) ?? null;
}

/** @param {{key: string, ctrlKey?: boolean, altKey?: boolean, metaKey?: boolean, shiftKey?: boolean}} event @param {Binding} binding */
export function fits(event, binding) {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const key = event.key.toLowerCase();
  const isLetter = key.length === 1 && key !== event.key.toUpperCase();
  return !(event.shiftKey && isLetter) && namesOf(binding).includes(key);
}

/** What works now, by groups of the same name in the order in which they came. @returns {[string, Binding[]][]} */
export function sheet() {
  const groups = new Map();
  for (const { group, list } of offers) {
    const working = list().filter(works);
    if (working.length > 0) groups.set(group, [...(groups.get(group) ?? []), ...working]);
  }
  return [...groups];
}

/** @type {Record<string, string>} */
const SIGNS = { arrowleft: "←", arrowright: "→", arrowup: "↑", arrowdown: "↓", delete: "Delete", enter: "Enter" };

/** How the keys of a binding are written on a keyboard: ["Q"], ["←", "→"]. @param {Binding} binding */
export const signsOf = (binding) => namesOf(binding).map((name) => SIGNS[name] ?? (name.length === 1 ? name.toUpperCase() : name));
