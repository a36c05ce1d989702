/** The camera card: the picture with its overlay, and what is known of the robot in words and numbers. */
import { openSetup } from "../calibration/setup.js";
import { BOARD_STEPS } from "../calibration/standing.js";
import { followAt } from "../live/actions.js";
import { useStore } from "../store.js";
import { fixed, quantity, wrapDegrees } from "../units.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { createPainter } from "./painter.js";
import { PointedCanvas, usePointer, useTaker } from "./pointing.js";
import { rigPictures } from "./rig_pictures.js";
import { frameAge, mayBeTold, STALE_S, trackingReason, trackingWords } from "./tracking.js";

const VIEWS = [["raw", "Picture"], ["mask", "Mask"]];

export function Camera() {
  const [view, setView] = useState("raw");
  const [overlay, setOverlay] = useState(true);
  const settingUp = useStore((state) => state.setup !== null);
  return html`
    <section class="card camera" aria-labelledby="camera-title">
      <header class="card-head">
        <h2 id="camera-title">Camera</h2>
        <button class="quiet" id="set-up-camera" type="button" aria-expanded=${settingUp} disabled=${settingUp} onClick=${openSetup}>Set up camera</button>
        <fieldset class="segments">
          <legend class="unseen">Picture shown</legend>
          ${VIEWS.map(([name, title]) => html`
            <label><input type="radio" name="camera-view" checked=${view === name} onChange=${() => setView(name)} /><span>${title}</span></label>
          `)}
        </fieldset>
        <label class="switch"><input type="checkbox" checked=${overlay} onChange=${(event) => setOverlay(event.target.checked)} />Overlay</label>
      </header>
      <${Picture} view=${view} overlay=${overlay} />
      <${RigReadings} />
    </section>
  `;
}

const LABEL = "Camera picture of the plate with the robot, its path and its target";

function Picture({ view, overlay }) {
  const canvas = useRef(null);
  const painter = useRef(null);
  useEffect(() => {
    painter.current = createPainter(canvas.current, rigPictures);
    return () => painter.current.close();
  }, []);
  useEffect(() => painter.current.show({ view, overlay }), [view, overlay]);
  return html`
    <div class="picture">
      <${PointedCanvas} canvas=${canvas} painter=${() => painter.current} label=${LABEL} />
      <${Notes} age=${() => painter.current?.age_s() ?? null} />
    </div>
  `;
}

/** Over the picture: how old it is and what a click would do; at its foot why the robot is not seen. */
function Notes({ age }) {
  const reason = useStore(({ tick, setup }) => (BOARD_STEPS.includes(setup?.step) ? "" : trackingReason(tick)));
  const ask = useStore((state) => mayBeTold(state.tick));
  usePointer(ask ? { words: "Click the robot: the one to follow", press: ({ u, v }) => followAt(u, v) } : null, { behind: true });
  const taker = useTaker();
  return html`
    <div class="picture-notes top" aria-live="polite">
      <${Age} age=${age} />
      ${taker?.words && html`<p class="picture-note asking">${taker.words}</p>`}
    </div>
    <div class="picture-notes foot" aria-live="polite">${reason && html`<p class="picture-note">${reason}</p>`}</div>
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

function RigReadings() {
  return html`<${Readings} tick=${useStore((state) => state.tick)} />`;
}

/** What a tick says of the robot, in words and numbers; waiting: what is said while there is none. */
export function Readings({ tick, waiting = trackingWords(null) }) {
  const pose = tick?.pose;
  const active = tick?.command?.field_mT > 0 ? (tick.command.pivot === 1 ? "A" : "B") : "none";
  return html`
    <dl class="readings">
      <div class="tracking" data-tracking=${tick?.tracking} title=${trackingReason(tick)}><dt>Tracking</dt><dd>${tick ? trackingWords(tick) : waiting}</dd></div>
      <div><dt>x</dt><dd>${quantity(pose?.x_mm, "mm")}</dd></div>
      <div><dt>y</dt><dd>${quantity(pose?.y_mm, "mm")}</dd></div>
      <div><dt>Heading</dt><dd>${quantity(pose ? wrapDegrees(pose.heading_deg) : null, "deg")}</dd></div>
      <div><dt>Pivot</dt><dd>${active}</dd></div>
      <div><dt>Error</dt><dd>${quantity(tick?.error_mm, "mm", 2)}</dd></div>
    </dl>
  `;
}
