/**
 * A card that takes the whole place below the bar. Not the browser's own full screen: there STOP would be out of sight,
 * and Escape would leave it instead of stopping.
 */
import { get, set, useStore } from "../store.js";
import { html, useEffect } from "../view.js";

/** @param {string} name @returns {boolean} */
export const useLarge = (name) => useStore((state) => state.large === name);

export const toggleLarge = (/** @type {string} */ name) => set({ large: get().large === name ? null : name });

/** @param {{name: string, what: string}} props name: of the card, in the store; what: it is called, as "the scene" */
export function LargeButton({ name, what }) {
  const large = useLarge(name);
  // A card that leaves the page gives the place back.
  useEffect(() => () => get().large === name && set({ large: null }), [name]);
  const words = large ? `Back to the whole page` : `Enlarge ${what}`;
  return html`
    <button class="quiet large-button" type="button" aria-pressed=${large} aria-label=${words} title=${words} onClick=${() => toggleLarge(name)}>
      <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true"><path d=${large ? INWARDS : OUTWARDS} fill="none" stroke="currentColor" stroke-width="1.6" /></svg>
    </button>
  `;
}

const OUTWARDS = "M9.5 2.5h4v4M13.5 2.5l-4.5 4.5M6.5 13.5h-4v-4M2.5 13.5l4.5-4.5";
const INWARDS = "M13 7h-4v-4M9 7l5-5M3 9h4v4M7 9l-5 5";
