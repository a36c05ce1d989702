/** In the run panel: a campaign has the rig, and what it does just now. */
import { showTab } from "../journal/tab.js";
import { html } from "../view.js";
import { openStudy, useStudies } from "./listing.js";

export function StudySign() {
  const study = useStudies(({ studies }) => studies?.find(({ on, state }) => on === "rig" && state === "running") ?? null);
  if (!study) return null;
  const show = () => {
    showTab("studies");
    openStudy(study.id);
  };
  return html`
    <div class="study-sign" role="group" aria-label="Study under way">
      <b>${study.name || study.id}</b>
      <span>${study.current || `${study.done} of ${study.total} runs`}</span>
      <button class="quiet" type="button" onClick=${show}>Show the study</button>
    </div>
  `;
}
