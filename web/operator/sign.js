/** In the bar: who operates. Pressed, it opens how to take control, give it back or ask for it. */
import { useKeys } from "../keys/bindings.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { Panel } from "./panel.js";
import { useNow } from "./question.js";
import { silence, standing, standingWords, whoOperates } from "./words.js";

export function OperatorSign() {
  const operator = useStore((state) => state.operator);
  const [open, setOpen] = useState(false);
  const place = useRef(null);
  const now = useNow(silence(operator, performance.now()) > 0);
  useKeys("Getting around", [{ key: "o", words: "Who operates: take control, give it back, ask for it", act: () => setOpen(!open) }]);
  useClosing(place, open, () => setOpen(false));
  const [who, more, short] = standing(operator, now);
  return html`
    <div class="operator" ref=${place} data-who=${whoOperates(operator)} data-silent=${silence(operator, now) > 0}>
      <button class="operator-sign" type="button" aria-expanded=${open} title=${standingWords(operator, now)} onClick=${() => setOpen(!open)}>
        <span class="operator-who">${who}</span><span class="operator-short" aria-hidden="true">${short}</span>
        <span class="operator-more">${more}</span>
      </button>
      ${open && html`<${Panel} close=${() => setOpen(false)} />`}
    </div>
  `;
}

/** A press or the focus elsewhere closes it, and so does Escape, which is STOP as well. @param {{current: any}} place @param {boolean} open @param {() => void} close */
function useClosing(place, open, close) {
  useEffect(() => {
    if (!open) return undefined;
    const leave = (/** @type {Event} */ event) => place.current.contains(event.target) || close();
    const press = (/** @type {KeyboardEvent} */ event) => event.key === "Escape" && close();
    addEventListener("pointerdown", leave, true);
    addEventListener("focusin", leave);
    addEventListener("keydown", press, true);
    return () => {
      removeEventListener("pointerdown", leave, true);
      removeEventListener("focusin", leave);
      removeEventListener("keydown", press, true);
      if (place.current?.contains(document.activeElement) || document.activeElement === document.body) place.current?.querySelector("button").focus();
    };
  }, [open]);
}
