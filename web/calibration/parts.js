/** The small parts that every step of the setup is made of. */
import { useStore } from "../store.js";
import { html, useState } from "../view.js";
import { undo, useSetup } from "./setup.js";

/** Changes of the camera want a disarmed rig. */
export const useDisarmed = () => useStore((state) => state.tick?.rig === "disarmed");

export const useBusy = () => useSetup((setup) => setup.working !== null);

/** A button that waits while something goes on. needsRest: only on a disarmed rig. */
export function Do({ act, children, primary = false, quiet = false, needsRest = false, disabled = false, pressed, label }) {
  const busy = useBusy();
  const disarmed = useDisarmed();
  const blocked = busy || disabled || (needsRest && !disarmed);
  const kind = primary ? "next" : quiet ? "quiet" : "";
  return html`<button type="button" class=${kind} disabled=${blocked} aria-pressed=${pressed} aria-label=${label} onClick=${act}>${children}</button>`;
}

/** What is chosen of several, at once on the page and until the rig has taken it or refused it. */
export function useChoice(current, take) {
  const [wanted, want] = useState(null);
  const choose = async (value) => {
    want(value);
    await take(value);
    want(null);
  };
  return [wanted ?? current, choose];
}

/** What goes on, what went wrong and what was done, at one place; Undo after a save that had a file before it. */
export function Outcome({ place, saved = "Saved in the rig file." }) {
  const { working, error, done } = useSetup(({ working: now, errors, done: all }) => ({
    working: now?.place === place ? now.words : "", error: errors[place] ?? "", done: all[place] ?? "",
  })) ?? {};
  const undoable = useStore((state) => Boolean(state.rig?.file?.previous));
  return html`
    <div class="outcome" aria-live="polite">
      ${working && html`<p class="working"><progress aria-label=${working}></progress>${working}…</p>`}
      ${error && html`<p class="field-error">${error}</p>`}
      ${done === "saved" && html`<p class="done"><span>✓ ${saved}</span>${undoable && html`<${Do} quiet needsRest act=${() => undo(place)}>Undo<//>`}</p>`}
      ${done === "undone" && html`<p class="done"><span>The rig file is as it was before.</span></p>`}
    </div>
  `;
}

/** One line of what is known: a title, a value, and a word of judgement. */
export function Fact({ title, children, grade }) {
  return html`<div><dt>${title}</dt><dd>${children}${grade && html` <span class="grade" data-grade=${grade}>${grade}</span>`}</dd></div>`;
}

/** "Saved now": the facts, or that there is nothing. */
export function Saved({ none, fits = true, why, children }) {
  return html`
    <section class="saved" aria-label="Saved now">
      <h3>Saved now</h3>
      ${none ? html`<p class="hint">${none}</p>` : html`<dl class="facts">${children}</dl>`}
      ${!fits && html`<p class="misfit">Not used: ${why}</p>`}
    </section>
  `;
}
