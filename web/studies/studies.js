/** The tab of studies: the list of them, one of them, or the form of a new one. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { compose } from "./composing.js";
import { Form } from "./form.js";
import { List } from "./list.js";
import { loadStudies, useStudies } from "./listing.js";
import { StudyPage } from "./study.js";

export function Studies() {
  const composing = useStore((state) => state.composing !== null);
  const open = useStudies((studies) => studies.open);
  if (composing) return html`<${Form} key="form" />`;
  if (open !== null) return html`<${StudyPage} key=${open} id=${open} />`;
  return html`<${All} />`;
}

function All() {
  const { studies, error } = useStudies((known) => known);
  const ready = useStore((state) => Boolean(state.selection && state.gaitSchema));
  return html`
    <section class="studies" aria-label="Studies">
      <header class="study-head">
        <p class="hint">A study walks many runs by itself and compares them: which tilt, which sweep, which controller.</p>
        <button class="next" type="button" disabled=${!ready} onClick=${() => compose()}>New study</button>
      </header>
      ${error && html`<p class="padded field-error" role="alert">${error} <button type="button" onClick=${loadStudies}>Try again</button></p>`}
      <${Content} studies=${studies} error=${error} />
    </section>
  `;
}

function Content({ studies, error }) {
  if (studies === null) return error ? null : html`<p class="hint padded">Loading the studies…</p>`;
  if (studies.length === 0) return html`<p class="hint padded">No study yet. A new one begins with what is selected in the run panel above.</p>`;
  return html`<${List} studies=${studies} />`;
}
