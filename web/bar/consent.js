/** Before current flows through real coils somebody says so: one calm question, with the way back at hand. */
import { armWithConsent } from "../live/actions.js";
import { set, useStore } from "../store.js";
import { html, useEffect, useRef } from "../view.js";

const close = () => set({ consentAsked: false });

export function ConsentDialog() {
  const asked = useStore((state) => state.consentAsked);
  const name = useStore((state) => state.rig?.name ?? "this rig");
  const dialog = useRef(null);
  useEffect(() => {
    if (asked) dialog.current.showModal();
    else dialog.current.close();
  }, [asked]);
  // Escape is STOP everywhere, and what the page does about a key keeps the browser from closing the dialog.
  useEffect(() => {
    const onKey = (event) => event.key === "Escape" && close();
    addEventListener("keydown", onKey, true);
    return () => removeEventListener("keydown", onKey, true);
  }, []);
  return html`
    <dialog ref=${dialog} aria-labelledby="consent-title" onClose=${close}>
      <h2 id="consent-title">Arm ${name}?</h2>
      <p>This rig is real: arming puts current into its coils.</p>
      <p class="hint">Nobody's hands are at the coils, nothing magnetic is near them, and somebody watches.</p>
      <div class="choice">
        <button class="primary" type="button" onClick=${armWithConsent}>Arm with current</button>
        <button type="button" autofocus onClick=${close}>Not now</button>
      </div>
    </dialog>
  `;
}
