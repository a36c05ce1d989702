/** Beside the scene: from where to look, what to show, and what the field's colours mean. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { look, toggleLayer } from "./channel.js";
import { LAYERS } from "./layers.js";
import { marks } from "./scale.js";

/** @type {[string, string, string][]} */
const VIEWS = [
  ["overview", "Overview", "Look at the whole rig"],
  ["above", "Above", "Look down on the plate as the camera does"],
  ["along", "Along", "Look along the plate"],
  ["inside", "Inside", "Look from between the coils"],
  ["follow", "Follow", "Keep the robot in the middle; turn and zoom as you like"],
];

export function Views() {
  const follows = useStore((state) => state.scene.follows);
  const off = useStore((state) => !state.scene.watching);
  return html`
    <div class="scene-views" role="group" aria-label="Look from">
      ${VIEWS.map(([name, title, words]) => html`
        <button class="quiet" type="button" key=${name} title=${words} disabled=${off}
          aria-pressed=${name === "follow" ? follows : undefined} onClick=${() => look(name)}>${title}</button>
      `)}
    </div>
  `;
}

export function Layers() {
  const shown = useStore((state) => state.scene.layers);
  return html`
    <fieldset class="scene-layers">
      <legend class="unseen">Shown in the scene</legend>
      ${LAYERS.map(([name, title, words]) => html`
        <label class="switch" key=${name} title=${words}><input type="checkbox" checked=${shown.includes(name)} onChange=${() => toggleLayer(name)} />${title}</label>
      `)}
    </fieldset>
  `;
}

/** What a colour of the field's arrows is worth; only while there are arrows to explain. */
export function FieldLegend() {
  const full = useStore((state) => state.scene.full_field_mT);
  const shown = useStore((state) => state.scene.layers.includes("field"));
  if (!shown || full === null) return null;
  return html`
    <div class="field-legend" role="img" aria-label=${`Colours of the field: dark is 0 mT, bright is ${full} mT`}>
      <span class="field-scale"></span>
      <span class="field-marks">${marks(full).map((mark) => html`<span>${mark}</span>`)}<span class="field-unit">mT</span></span>
    </div>
  `;
}
