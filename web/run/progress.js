/** How the run that is going on does, in numbers: what is left and how well it follows come first. */
import { useStore } from "../store.js";
import { clock, fixed, quantity } from "../units.js";
import { html } from "../view.js";

export function Progress() {
  const run = useStore((state) => state.tick?.run ?? null);
  const error = useStore((state) => state.tick?.error_mm);
  const label = useStore((state) => state.walked?.label ?? "");
  if (!run) return null;
  const share = run.passes > 0 ? Math.min(1, run.passes_done / run.passes) : 0;
  const left = Math.max(0, (run.duration_s ?? 0) - run.elapsed_s);
  return html`
    <div class="progress">
      ${label && html`<p class="run-label">${label}</p>`}
      <progress max="1" value=${share} aria-label="Share of the run that is done"></progress>
      <dl class="figures">
        <div><dt>Left</dt><dd>${clock(left)} <span class="soft">of ${clock(run.duration_s)} min</span></dd></div>
        <div><dt>Error now</dt><dd>${quantity(error, "mm", 2)}</dd></div>
        <div><dt>Mean error</dt><dd>${quantity(run.mean_error_mm, "mm", 2)}</dd></div>
        <div><dt>Passes</dt><dd>${fixed(run.passes_done, 2)} <span class="soft">of ${run.passes}</span></dd></div>
        <div><dt>Steps</dt><dd>${run.steps}</dd></div>
        <div><dt>Sweeps</dt><dd>${run.sweeps}</dd></div>
      </dl>
    </div>
  `;
}
