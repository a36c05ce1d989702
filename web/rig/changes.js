/** At the foot of the rig's tab: what would change, from what to what; saving it, taking it back, and what came of it. */
import { disarm, reset } from "../live/actions.js";
import { useStore } from "../store.js";
import { html, useMemo } from "../view.js";
import { changesOf } from "./fields.js";
import { discard, save, undo, useRigPage } from "./settings.js";

export function ChangeBar({ sections }) {
  const draft = useRigPage((page) => page.draft);
  const rig = useStore((state) => state.rig);
  const { working, error, done } = useRigPage((page) => page);
  const changes = useMemo(() => changesOf(sections, draft, rig), [sections, draft, rig]);
  if (changes.length === 0 && !working && !error && !done) return null;
  return html`
    <section class="rig-changes" aria-label="Changes">
      ${changes.length > 0 && html`<${Changes} changes=${changes} />`}
      <div class="rig-outcome" aria-live="polite">
        ${working && html`<p class="working"><progress aria-label=${working}></progress>${working}…</p>`}
        ${error && html`<p class="field-error">${error}</p>`}
        ${done && html`<${Done} done=${done} />`}
      </div>
    </section>
  `;
}

function Changes({ changes }) {
  const state = useStore(({ tick }) => tick?.rig ?? "");
  const working = useRigPage((page) => page.working !== "");
  const invalid = useStore(({ draftErrors }) => Object.keys(draftErrors).some((key) => key.startsWith("rig.")));
  const waits = changes.some(({ live }) => !live) && state !== "disarmed";
  return html`
    <ul class="rig-differences" aria-label="Not saved yet">
      ${changes.map(({ path, title, from, to }) => html`
        <li key=${path}><span>${title}</span><span><s class="soft">${from}</s> → <strong>${to}</strong></span>
          <button class="quiet" type="button" aria-label=${`Take back ${title}`} onClick=${() => discard(path)}>Take back</button></li>`)}
    </ul>
    ${waits && html`<${NotAtRest} state=${state} />`}
    <div class="row">
      <button class="next" type="button" disabled=${working || waits || invalid} onClick=${save}>Save ${changes.length === 1 ? "the change" : `${changes.length} changes`}</button>
      <button type="button" disabled=${working} onClick=${() => discard("")}>Discard</button>
      ${invalid && html`<span class="field-error">One value cannot be used yet.</span>`}
    </div>
  `;
}

/** Most values are built into the machine: it must be at rest to be exchanged. */
export function NotAtRest({ state }) {
  const busy = useStore((now) => now.busy !== null);
  const [words, name, act] = state === "fault"
    ? ["The rig has stopped. This can be saved once it is reset.", "Reset", reset]
    : [`The rig is ${state || "not known yet"}. This can be saved only while it is disarmed.`, "Disarm", disarm];
  return html`<div class="guard" role="group" aria-label="State of the rig"><p>${words}</p><button type="button" disabled=${busy || !state} onClick=${act}>${name}</button></div>`;
}

function Done({ done }) {
  const disarmed = useStore(({ tick }) => tick?.rig === "disarmed");
  const undoable = useStore((state) => Boolean(state.rig?.file?.previous));
  return html`
    <p class="done"><span>✓ ${done.words}</span>
      ${done.undo && undoable && html`<button class="quiet" type="button" disabled=${!disarmed} title=${disarmed ? "The rig file as it was before" : "The rig must be disarmed for it"} onClick=${undo}>Undo</button>`}</p>
  `;
}
