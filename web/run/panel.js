/** The run panel: one obvious button, how the run goes, and the settings of the next one. */
import { JogPanel } from "../jog/panel.js";
import { useKeys } from "../keys/bindings.js";
import { pauseRun } from "../live/actions.js";
import { Elsewhere } from "../live/elsewhere.js";
import { get, useStore } from "../store.js";
import { html } from "../view.js";
import { Actions } from "./actions.js";
import { Progress } from "./progress.js";
import { Settings } from "./settings.js";
import { StudySign } from "../studies/sign.js";

/** To let a run go on puts current into the coils, which no key does. */
const KEYS = [
  { key: "h", words: "Hold the run: coils to zero, the run is kept", act: pauseRun, when: () => get().tick?.rig === "running" },
];

export function RunPanel() {
  useKeys("Run", KEYS);
  const ready = useStore((state) => Boolean(state.selection && state.gaitSchema));
  return html`
    <section class="card run" aria-labelledby="run-title">
      <header class="card-head"><h2 id="run-title">Run</h2><${Elsewhere} /></header>
      <${Actions} />
      <${JogPanel} />
      <${StudySign} />
      <${Progress} />
      ${ready ? html`<${Settings} />` : html`<p class="hint padded">Loading the settings…</p>`}
    </section>
  `;
}
