/** How the run that is going on does, in numbers. */
import { useStore } from "../store.js";
import { clock, fixed, quantity } from "../units.js";
import { html } from "../view.js";

export function Progress() {
  const run = useStore((state) => state.tick?.run ?? null);
  if (!run) return null;
  const share = run.passes > 0 ? Math.min(1, run.passes_done / run.passes) : 0;
  return html`
    <div class="progress">
      <progress max="1" value=${share} aria-label="Share of the run that is done"></progress>
      <dl class="figures">
        <div><dt>Time, min</dt><dd>${clock(run.elapsed_s)} <span class="soft">of ${clock(run.duration_s)}</span></dd></div>
        <div><dt>Passes</dt><dd>${fixed(run.passes_done, 2)} <span class="soft">of ${run.passes}</span></dd></div>
        <div><dt>Mean error</dt><dd>${quantity(run.mean_error_mm, "mm", 2)}</dd></div>
        <div><dt>Steps</dt><dd>${run.steps}</dd></div>
        <div><dt>Sweeps</dt><dd>${run.sweeps}</dd></div>
        <div><dt>Reversals</dt><dd>${run.reversals}</dd></div>
      </dl>
    </div>
  `;
}
