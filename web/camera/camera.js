/** The camera card: the picture with its overlay and tools, and what is known of the robot in words and numbers. */
import { openSetup } from "../calibration/setup.js";
import { BOARD_STEPS } from "../calibration/standing.js";
import { LargeButton, useLarge } from "../card/large.js";
import { drawKeys } from "../draw/keys.js";
import { DrawPanel } from "../draw/panel.js";
import { useKeys } from "../keys/bindings.js";
import { followAt } from "../live/actions.js";
import { MeasurePanel } from "../measure/panel.js";
import { useStore } from "../store.js";
import { fixed, quantity, wrapDegrees } from "../units.js";
import { html, useEffect, useMemo, useRef, useState } from "../view.js";
import { createPainter } from "./painter.js";
import { PointedCanvas } from "./pointed_canvas.js";
import { usePointer, useTaker } from "./pointing.js";
import { rigPictures } from "./rig_pictures.js";
import { closeTool, PointingTools, ZoomTools } from "./tools.js";
import { frameAge, mayBeTold, STALE_S, trackingReason, trackingWords } from "./tracking.js";
import { createZoom } from "./zoom.js";

const VIEWS = [["raw", "Picture"], ["mask", "Mask"]];
const PANELS = { draw: DrawPanel, measure: MeasurePanel };
/** Heeded by the picture itself while it has the focus. */
const PICTURE_KEYS = [
  { key: ["+", "-", "0"], words: "closer, wider, the whole picture (with the picture focused; also the mouse wheel)" },
  { key: ["arrowleft", "arrowright", "arrowup", "arrowdown"], words: "move a zoomed picture, or the crosshair while a click is awaited (Shift: far)" },
  { key: "enter", words: "click at the crosshair" },
];

export function Camera() {
  const [view, setView] = useState("raw");
  const [overlay, setOverlay] = useState(true);
  const settingUp = useStore((state) => state.setup !== null);
  const tool = useStore((state) => (state.setup === null ? state.tool : null));
  const Panel = tool && PANELS[tool];
  const large = useLarge("camera");
  useKeys("Camera picture", PICTURE_KEYS);
  return html`
    <section class="card camera" aria-labelledby="camera-title" data-large=${large} onKeyDown=${tool === "draw" ? drawKeys : undefined}>
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
        ${!settingUp && html`<${LargeButton} name="camera" what="the camera picture" />`}
      </header>
      <${Picture} view=${view} overlay=${overlay} tools=${!settingUp} />
      ${Panel && html`<${Panel} close=${closeTool} />`}
      <${RigReadings} />
    </section>
  `;
}

const LABEL = "Camera picture of the plate with the robot, its path and its target";

function Picture({ view, overlay, tools }) {
  const canvas = useRef(null);
  const painter = useRef(null);
  const zoom = useMemo(createZoom, []);
  const [hand, setHand] = useState(false);
  const [age, setAge] = useState(null);
  const pointing = useTaker() !== null;
  const sight = () => painter.current.sight;
  useEffect(() => {
    painter.current = createPainter(canvas.current, rigPictures, zoom);
    const timer = setInterval(() => setAge(tenths(painter.current.age_s())), 100);
    return () => {
      clearInterval(timer);
      painter.current.close();
    };
  }, []);
  useEffect(() => painter.current.show({ view, overlay }), [view, overlay]);
  const known = useStore((state) => tenths(frameAge(age, state.tick)));
  return html`
    <div class="picture">
      <${PointedCanvas} canvas=${canvas} sight=${sight} zoom=${zoom} hand=${hand && pointing} stale=${known !== null && known > STALE_S} label=${LABEL} />
      ${tools && html`<${PointingTools} />`}
      <${ZoomTools} zoom=${zoom} sight=${sight} pointing=${pointing} hand=${hand} setHand=${setHand} />
      <${Notes} age=${known} view=${view} />
    </div>
  `;
}

/** Ages change ten times a second at most; while all is fresh, nothing is drawn anew. */
const tenths = (seconds) => (seconds === null ? null : seconds <= STALE_S ? 0 : Math.round(seconds * 10) / 10);

/** Over the picture: how old it is and what a click would do; at its foot why the robot is not seen. */
function Notes({ age, view }) {
  const reason = useStore(({ tick, setup }) => (BOARD_STEPS.includes(setup?.step ?? "") ? "" : trackingReason(tick)));
  const ask = useStore((state) => mayBeTold(state.tick));
  usePointer(ask ? { words: "Click the robot: the one to follow", press: ({ u, v }) => followAt(u, v) } : null, { behind: true });
  const taker = useTaker();
  return html`
    <div class="picture-notes top" aria-live="polite">
      <${Age} seconds=${age} />
      ${taker?.words && html`<p class="picture-note asking">${taker.words}</p>`}
    </div>
    <div class="picture-notes foot" aria-live="polite">
      ${view === "mask" && html`<p class="picture-note">White: what counts as robot by its colour. Dotted: where it is looked for.</p>`}
      ${reason && html`<p class="picture-note">${reason}</p>`}
    </div>
  `;
}

/** "no frame for 1.2 s", on the picture itself. */
function Age({ seconds }) {
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
