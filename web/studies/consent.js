/** Before a campaign puts current through the coils of a real rig, for hours, somebody says so. */
import { Ask } from "../ask.js";
import { get, useStore } from "../store.js";
import { html } from "../view.js";

/** Whether the question is to be asked: only a rig that is not simulated. */
export const needsConsent = (on) => on === "rig" && !get().tick?.simulated;

/** @param props go: what is done once somebody agrees; close */
export function CampaignConsent({ go, close }) {
  const name = useStore((state) => state.rig?.name ?? "this rig");
  const agree = () => {
    close();
    go();
  };
  return html`
    <${Ask} title=${`Walk a study on ${name}?`} close=${close}>
      <p>This rig is real: the study arms it and puts current into its coils, run after run, also while nobody looks.</p>
      <p class="hint">Nobody's hands are at the coils, nothing magnetic is near them, and the supply may stay on unattended. Read SAFETY.md first.</p>
      <div class="choice">
        <button class="primary" type="button" onClick=${agree}>Start with current</button>
        <button type="button" data-first onClick=${close}>Not now</button>
      </div>
    <//>
  `;
}
