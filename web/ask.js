/**
 * A question that covers the page but never the bar: STOP stays in reach of mouse, finger and keys.
 * Escape is STOP, and puts the question away as well.
 */
import { html, useEffect, useRef } from "./view.js";

export function Ask({ title, close, children }) {
  const dialog = useRef(null);
  useEffect(() => {
    const from = document.activeElement;
    dialog.current.querySelector("[data-first]")?.focus();
    const onKey = (event) => event.key === "Escape" && close();
    addEventListener("keydown", onKey, true);
    return () => {
      removeEventListener("keydown", onKey, true);
      if (from?.isConnected) from.focus();
    };
  }, []);
  const press = (event) => event.target === event.currentTarget && close();
  return html`
    <div class="veil" onClick=${press}>
      <dialog open ref=${dialog} aria-modal="true" aria-labelledby="ask-title" onKeyDown=${(event) => keepInside(event, dialog.current)}>
        <h2 id="ask-title">${title}</h2>
        ${children}
      </dialog>
    </div>
  `;
}

/** Tab goes round inside the question. */
function keepInside(event, dialog) {
  if (event.key !== "Tab") return;
  const stations = [...dialog.querySelectorAll("button:enabled, input:enabled")];
  const [first, last] = [stations[0], stations.at(-1)];
  const from = event.shiftKey ? first : last;
  if (document.activeElement !== from) return;
  event.preventDefault();
  (event.shiftKey ? last : first).focus();
}
