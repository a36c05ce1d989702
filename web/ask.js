/**
 * A question that covers the page but never the bar: STOP stays in reach of mouse, finger and keys.
 * Escape is STOP, and puts the question away as well.
 */
import { html, useEffect, useRef } from "./view.js";

/** Where the focus can stand. */
const STATIONS = "button:enabled, input:enabled, select:enabled, textarea:enabled, a[href], summary";

/** @param {{title: string, close: () => void, children?: any}} props */
export function Ask({ title, close, children }) {
  const dialog = useRef(null);
  useEffect(() => {
    const from = /** @type {HTMLElement | null} */ (document.activeElement);
    dialog.current.querySelector("[data-first]")?.focus();
    const onKey = (/** @type {KeyboardEvent} */ event) => event.key === "Escape" && close();
    addEventListener("keydown", onKey, true);
    return () => {
      removeEventListener("keydown", onKey, true);
      if (from?.isConnected) from.focus();
    };
  }, []);
  const press = (/** @type {MouseEvent} */ event) => event.target === event.currentTarget && close();
  return html`
    <div class="veil" onClick=${press}>
      <dialog open ref=${dialog} aria-modal="true" aria-labelledby="ask-title" onKeyDown=${(/** @type {KeyboardEvent} */ event) => keepInside(event, dialog.current)}>
        <h2 id="ask-title">${title}</h2>
        ${children}
      </dialog>
    </div>
  `;
}

/** Tab goes round inside the question. @param {KeyboardEvent} event @param {HTMLElement} dialog */
function keepInside(event, dialog) {
  if (event.key !== "Tab") return;
  const stations = /** @type {HTMLElement[]} */ ([...dialog.querySelectorAll(STATIONS)]);
  const [first, last] = [stations[0], stations.at(-1)];
  const from = event.shiftKey ? first : last;
  if (document.activeElement !== from) return;
  event.preventDefault();
  (event.shiftKey ? last : first)?.focus();
}
