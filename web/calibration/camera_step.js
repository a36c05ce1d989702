/** Which camera looks at the plate. */
import { patch } from "../live/rest.js";
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html, useState } from "../view.js";
import { Do, Fact, Outcome, Saved, useBusy, useChoice, useDisarmed } from "./parts.js";
import { change, learn, saving, useSetup } from "./setup.js";

const PLACE = "cameras";
const SIMULATED = "sim://";

async function use(uri) {
  if ((await saving(PLACE, "Opening the camera", () => patch("/rig", { camera: { uri } }))) === null) return;
  await Promise.all(["cameras", "vision", "calibration"].map(learn));
}

async function lookAgain() {
  change({ cameras: null });
  await learn("cameras");
}

export function CameraStep() {
  const cameras = useSetup((setup) => setup.cameras);
  const uri = useStore((state) => state.rig?.camera?.uri ?? "");
  const size = useStore((state) => state.camera?.size);
  const rate = useStore((state) => state.tick?.loop?.rate_Hz);
  return html`
    <p class="lead">Choose the camera that looks down on the plate, and aim it so that the whole plate is in the picture.</p>
    <${List} cameras=${cameras} uri=${uri} />
    <div class="row"><${Do} quiet act=${lookAgain}>Look again<//></div>
    <${Outcome} place=${PLACE} />
    <details class="more">
      <summary>A camera on the network, or a video file</summary>
      <${Address} />
    </details>
    <${Saved}>
      <${Fact} title="Source">${uri === SIMULATED ? "the simulated camera" : uri}<//>
      <${Fact} title="Picture">${size ? `${size[0]} × ${size[1]} px` : "–"}, ${fixed(rate, 0)} a second<//>
    <//>
  `;
}

function List({ cameras, uri }) {
  const busy = useBusy();
  const disarmed = useDisarmed();
  const [chosen, choose] = useChoice(cameras?.find((camera) => camera.in_use)?.uri ?? uri, use);
  const failed = useSetup((setup) => Boolean(setup.errors[PLACE]));
  if (cameras === null) return failed ? null : html`<p class="hint">Looking for cameras…</p>`;
  if (cameras.length === 0) return html`<p class="hint">No camera is plugged into this computer.</p>`;
  return html`
    <fieldset class="choices" disabled=${busy || !disarmed}>
      <legend class="unseen">Cameras</legend>
      ${cameras.map((camera) => html`
        <label class="choice-row" key=${camera.uri}>
          <input type="radio" name="camera-source" checked=${camera.uri === chosen} onChange=${() => choose(camera.uri)} />
          <span><strong>${camera.name}</strong><span class="soft">${aboutOf(camera)}</span></span>
        </label>
      `)}
    </fieldset>
  `;
}

/** The largest picture and the fastest rate, and what tells this camera from another of its kind. */
function aboutOf({ identity, sizes, rates_Hz: rates, path }) {
  const largest = [...(sizes ?? [])].sort((a, b) => b[0] * b[1] - a[0] * a[1])[0];
  const parts = [largest && `up to ${largest[0]} × ${largest[1]} px`, rates?.length && `${fixed(Math.max(...rates), 0)} a second`];
  return [...parts, path, identity].filter(Boolean).join(" · ");
}

function Address() {
  const [text, setText] = useState("");
  const go = (event) => {
    event.preventDefault();
    if (text.trim()) use(text.trim());
  };
  return html`
    <form class="row" onSubmit=${go}>
      <input type="text" aria-label="Address" placeholder="rtsp://… , http://… or file:///…" value=${text} onInput=${(event) => setText(event.target.value)} />
      <${Do} needsRest disabled=${!text.trim()} act=${() => use(text.trim())}>Use<//>
    </form>
  `;
}
