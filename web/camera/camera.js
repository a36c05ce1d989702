/** The camera card: the picture with its overlay, and what is known of the robot in words and numbers. */
import { useStore } from "../store.js";
import { fixed, quantity, wrapDegrees } from "../units.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { createPainter } from "./painter.js";
import { frameAge, STALE_S, trackingWords } from "./tracking.js";

const VIEWS = [["raw", "Picture"], ["mask", "Mask"]];

export function Camera() {
  const [view, setView] = useState("raw");
  const [overlay, setOverlay] = useState(true);
  return html`
    <section class="card camera" aria-labelledby="camera-title">
      <header class="card-head">
        <h2 id="camera-title">Camera</h2>
        <fieldset class="segments">
          <legend class="unseen">Picture shown</legend>
          ${VIEWS.map(([name, title]) => html`
            <label><input type="radio" name="camera-view" checked=${view === name} onChange=${() => setView(name)} /><span>${title}</span></label>
          `)}
        </fieldset>
        <label class="switch"><input type="checkbox" checked=${overlay} onChange=${(event) => setOverlay(event.target.checked)} />Overlay</label>
      </header>
      <${Picture} view=${view} overlay=${overlay} />
      <${Readings} />
    </section>
  `;
}

function Picture({ view, overlay }) {
  const canvas = useRef(null);
  const painter = useRef(null);
  useEffect(() => {
    painter.current = createPainter(canvas.current);
    return () => painter.current.close();
  }, []);
  useEffect(() => painter.current.show({ view, overlay }), [view, overlay]);
  return html`
    <div class="picture">
      <canvas ref=${canvas} role="img" aria-label="Camera picture of the plate with the robot, its path and its target"></canvas>
      <${Age} age=${() => painter.current?.age_s() ?? null} />
    </div>
  `;
}

/** "no frame for 1.2 s", on the picture itself. */
function Age({ age }) {
  const tick = useStore((state) => state.tick);
  const [pictureAge, setPictureAge] = useState(null);
  useEffect(() => {
    const timer = setInterval(() => setPictureAge(age()), 100);
    return () => clearInterval(timer);
  }, []);
  const seconds = frameAge(pictureAge, tick);
  if (seconds === null) return html`<p class="picture-note">waiting for the first frame</p>`;
  if (seconds <= STALE_S) return null;
  return html`<p class="picture-note stale">no frame for ${fixed(seconds, 1)} s</p>`;
}

function Readings() {
  const tick = useStore((state) => state.tick);
  const pose = tick?.pose;
  const active = tick?.command?.field_mT > 0 ? (tick.command.pivot === 1 ? "A" : "B") : "none";
  return html`
    <dl class="readings">
      <div class="tracking" data-tracking=${tick?.tracking}><dt>Tracking</dt><dd>${trackingWords(tick)}</dd></div>
      <div><dt>x</dt><dd>${quantity(pose?.x_mm, "mm")}</dd></div>
      <div><dt>y</dt><dd>${quantity(pose?.y_mm, "mm")}</dd></div>
      <div><dt>Heading</dt><dd>${quantity(pose ? wrapDegrees(pose.heading_deg) : null, "deg")}</dd></div>
      <div><dt>Pivot</dt><dd>${active}</dd></div>
      <div><dt>Error</dt><dd>${quantity(tick?.error_mm, "mm", 2)}</dd></div>
    </dl>
  `;
}
