/** The tools in the picture: what a click does, and which part of the picture is shown. */
import { openSetup, goTo } from "../calibration/setup.js";
import { set, useStore } from "../store.js";
import { html } from "../view.js";
import { ZOOM_STEP } from "./pointed_canvas.js";
import { useZoom } from "./zoom_hook.js";

/** Strokes in a box of 24. */
const ICONS = {
  draw: "M4 20c3-9 6 2 9-5s1-9 7-11M4 20h.01M20 4h.01",
  measure: "M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  colour: "m13 7 4 4M15 5l4 4M14 8l-9 9-1 4 4-1 9-9M15 5l2-2 4 4-2 2",
  closer: "M12 5v14M5 12h14",
  wider: "M5 12h14",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  hand: "M12 3v18M3 12h18M9 6l3-3 3 3M9 18l3 3 3-3M6 9l-3 3 3 3M18 9l3 3-3 3",
};

function Tool({ icon, label, pressed, disabled, act }) {
  return html`
    <button type="button" aria-label=${label} title=${label} aria-pressed=${pressed} disabled=${disabled} onClick=${act}>
      <svg viewBox="0 0 24 24" aria-hidden="true"><path d=${ICONS[icon]} /></svg>
    </button>
  `;
}

export const closeTool = () => set({ tool: null });

const toggle = (name, active) => set({ tool: active ? null : name });

function pickColour() {
  closeTool();
  openSetup();
  goTo("colour");
}

/** The camera's setup takes the pointer for itself. */
export function PointingTools() {
  const tool = useStore((state) => state.tool);
  const disabled = useStore((state) => state.camera === null);
  return html`
    <div class="picture-tools" role="toolbar" aria-label="Camera tools">
      <${Tool} icon="draw" label="Draw a path" pressed=${tool === "draw"} disabled=${disabled} act=${() => toggle("draw", tool === "draw")} />
      <${Tool} icon="measure" label="Measure a distance" pressed=${tool === "measure"} disabled=${disabled} act=${() => toggle("measure", tool === "measure")} />
      <${Tool} icon="colour" label="Pick the robot’s colour" disabled=${disabled} act=${pickColour} />
    </div>
  `;
}

/** pointing: a click means something, so that a hand is needed to move the picture with the mouse. */
export function ZoomTools({ zoom, sight, pointing, hand, setHand }) {
  const zoomed = useZoom(zoom).zoom > 1;
  return html`
    <div class="picture-tools zoom" role="toolbar" aria-label="Zoom">
      <${Tool} icon="closer" label="Zoom in" act=${() => sight().step(ZOOM_STEP)} />
      <${Tool} icon="wider" label="Zoom out" disabled=${!zoomed} act=${() => sight().step(1 / ZOOM_STEP)} />
      ${zoomed && html`<${Tool} icon="fit" label="Show the whole picture" act=${() => sight().fit()} />`}
      ${zoomed && pointing && html`<${Tool} icon="hand" label="Move the picture" pressed=${hand} act=${() => setHand(!hand)} />`}
    </div>
  `;
}
