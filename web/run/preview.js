/** A small picture of the path over the workspace. */
import { useStore } from "../store.js";
import { clock, quantity } from "../units.js";
import { html } from "../view.js";

/** A path step of this is the path's own speed (the paper's control tick), s. */
const CONTROL_TICK_S = 0.1;
const DEFAULT_WORKSPACE_MM = 120;

export function PathPicture() {
  const path = useStore((state) => state.path);
  const step = useStore((state) => state.selection.gait.path_step_s);
  const side = useStore((state) => state.rig?.limits?.workspace_mm ?? DEFAULT_WORKSPACE_MM);
  if (!path) return html`<p class="hint path-missing">No path for these values.</p>`;
  const half = side / 2;
  const points = path.points_mm.map(([x, y]) => `${x.toFixed(2)},${(-y).toFixed(2)}`).join(" ");
  const [startX, startY] = path.points_mm[0] ?? [0, 0];
  return html`
    <figure class="path">
      <svg viewBox=${`${-half} ${-half} ${side} ${side}`} role="img" aria-label="The path in the workspace">
        <rect x=${-half} y=${-half} width=${side} height=${side} class="path-plate" />
        <path d=${`M${-half} 0H${half}M0 ${-half}V${half}`} class="path-axes" />
        <polyline points=${points} class="path-line" />
        <circle cx=${startX} cy=${-startY} r=${side / 36} class="path-start" />
      </svg>
      <figcaption>
        <span>${quantity(path.length_mm, "mm", 0)} long</span>
        <span>${clock((path.duration_s * CONTROL_TICK_S) / step)} min a pass</span>
        <span class="soft">plate ${quantity(side, "mm", 0)} square</span>
      </figcaption>
    </figure>
  `;
}
