/** Beside the settings: somebody else has changed them, in another tab or by a script. */
import { set, useStore } from "../store.js";
import { html, useEffect } from "../view.js";

const SHOWN_MS = 10000;

export function Elsewhere() {
  const elsewhere = useStore((state) => state.elsewhere);
  useEffect(() => {
    if (!elsewhere) return undefined;
    const timer = setTimeout(() => set({ elsewhere: null }), SHOWN_MS);
    return () => clearTimeout(timer);
  }, [elsewhere]);
  return html`<p class="elsewhere" role="status">${elsewhere && wordsOf(elsewhere)}</p>`;
}

/** @param {{taken: string[], kept: string[]}} elsewhere */
function wordsOf({ taken, kept }) {
  if (kept.length > 0) return `${listed(kept)} changed in another tab as well; this tab’s is kept.`;
  return `${listed(taken)} changed in another tab.`;
}

/** @param {string[]} parts */
const listed = (parts) => parts.join(" and ").replace(/^./, (letter) => letter.toUpperCase());
