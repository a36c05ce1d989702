/** Before a study goes: what goes with it and what stays. */
import { Ask } from "../ask.js";
import { counted } from "../runs/words.js";
import { html } from "../view.js";
import { deleteStudy } from "./listing.js";

export function DeleteDialog({ study, close }) {
  const go = async () => {
    close();
    await deleteStudy(study.id);
  };
  return html`
    <${Ask} title=${`Delete ${study.name || study.id}?`} close=${close}>
      <p>Its table of ${counted(study.done, "run")} and its report go. This cannot be undone.</p>
      ${study.on === "rig" && html`<p class="hint">Its runs and their recordings stay in the list of runs.</p>`}
      <div class="choice">
        <button class="danger" type="button" onClick=${go}>Delete</button>
        <button type="button" data-first onClick=${close}>Keep</button>
      </div>
    <//>
  `;
}
