/** A small picture of the path over the workspace. */
import { useStore } from "../store.js";
import { clock, quantity } from "../units.js";
import { html } from "../view.js";

/** A path step of this is the path's own speed (the paper's control tick), s. */
const CONTROL_TICK_S = 0.1;
const DEFAULT_WORKSPACE_MM = 120;

/**
 * How long one pass takes by the gait's time law, s; a robot that is waited for takes longer.
 * @param {{length_mm: number, duration_s: number}} path @param {Record<string, any>} gait
 */
export function passTime({ length_mm, duration_s }, gait) {
  const { time_law, path_step_s, speed_mm_s, acceleration_mm_s2 } = gait;
  if (time_law === "path_step") return (duration_s * CONTROL_TICK_S) / path_step_s;
  if (time_law !== "trapezoidal") return length_mm / speed_mm_s;
  const peak = Math.min(speed_mm_s, Math.sqrt(acceleration_mm_s2 * length_mm));
  return length_mm / peak + peak / acceleration_mm_s2;
}

export function PathPicture() {
  const path = useStore((state) => state.path);
  const gait = useStore((state) => /** @type {any} */ (state.selection?.gait));
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
        <span>${clock(passTime(path, gait))} min a pass</span>
        <span class="soft">plate ${quantity(side, "mm", 0)} square</span>
      </figcaption>
    </figure>
  `;
}
