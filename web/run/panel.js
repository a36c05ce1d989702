/** The run panel: one obvious button, how the run goes, and the settings of the next one. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { Actions } from "./actions.js";
import { Progress } from "./progress.js";
import { Settings } from "./settings.js";
import { StudySign } from "../studies/sign.js";

export function RunPanel() {
  const ready = useStore((state) => Boolean(state.selection && state.gaitSchema));
  return html`
    <section class="card run" aria-labelledby="run-title">
      <header class="card-head"><h2 id="run-title">Run</h2></header>
      <${Actions} />
      <${StudySign} />
      <${Progress} />
      ${ready ? html`<${Settings} />` : html`<p class="hint padded">Loading the settings…</p>`}
    </section>
  `;
}
