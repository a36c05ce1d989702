/** Before runs are deleted: which ones, and how much that is. Pinned ones and one that goes on stay. */
import { Ask } from "../ask.js";
import { html, useState } from "../view.js";
import { deleteRuns } from "./inspected.js";
import { bytes, counted, nameOf } from "./words.js";

const NAMED = 6;

const sizeOf = (runs) => runs.reduce((sum, run) => sum + (run.recording?.size_bytes ?? 0), 0);
const stays = (run) => Boolean(run.pinned) || run.state === "running";

export function DeleteDialog({ runs, close }) {
  const [working, work] = useState(false);
  const [refused, refuse] = useState([]);
  const doomed = runs.filter((run) => !stays(run));
  const kept = runs.filter(stays);
  const go = async () => {
    work(true);
    const left = await deleteRuns(doomed, nameOf);
    work(false);
    if (left.length === 0) close();
    else refuse(left);
  };
  const title = doomed.length === 1 ? `Delete ${nameOf(doomed[0])}?` : `Delete ${counted(doomed.length, "run")}?`;
  return html`
    <${Ask} title=${doomed.length > 0 ? title : "Nothing to delete"} close=${close}>
      ${doomed.length > 1 && html`<${Names} runs=${doomed} />`}
      ${doomed.length > 0 && html`<p>The recording goes with it: ${bytes(sizeOf(doomed))}. This cannot be undone.</p>`}
      ${kept.length > 0 && html`<p class="hint">${kept.map(nameOf).join(", ")} ${kept.length === 1 ? "stays" : "stay"}: pinned or still running.</p>`}
      <div class="outcome" aria-live="polite">${refused.map((text) => html`<p class="field-error" key=${text}>${text}</p>`)}</div>
      <div class="choice">
        <button class="danger" type="button" disabled=${working || doomed.length === 0} onClick=${go}>${working ? "Deleting…" : "Delete"}</button>
        <button type="button" data-first onClick=${close}>Keep</button>
      </div>
    <//>
  `;
}

export function Names({ runs }) {
  const rest = runs.length - NAMED;
  return html`
    <ul class="named">
      ${runs.slice(0, NAMED).map((run) => html`<li key=${run.id}>${nameOf(run)} <span class="soft">${bytes(run.recording?.size_bytes)}</span></li>`)}
      ${rest > 0 && html`<li class="soft">and ${rest.toLocaleString("en")} more</li>`}
    </ul>
  `;
}
