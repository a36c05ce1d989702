/** Before current flows through real coils somebody says so: one calm question, with the way back at hand. */
import { Ask } from "../ask.js";
import { armWithConsent } from "../live/actions.js";
import { set, useStore } from "../store.js";
import { html } from "../view.js";

const close = () => set({ consentAsked: false });

export function ConsentDialog() {
  const asked = useStore((state) => state.consentAsked);
  const name = useStore((state) => state.rig?.name ?? "this rig");
  if (!asked) return null;
  return html`
    <${Ask} title=${`Arm ${name}?`} close=${close}>
      <p>This rig is real: arming puts current into its coils.</p>
      <p class="hint">Nobody's hands are at the coils, nothing magnetic is near them, and somebody watches.</p>
      <div class="choice">
        <button class="primary" type="button" onClick=${armWithConsent}>Arm with current</button>
        <button type="button" data-first onClick=${close}>Not now</button>
      </div>
    <//>
  `;
}
