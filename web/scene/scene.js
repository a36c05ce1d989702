/** The 3D scene, with what each viewer may choose of it; loaded once the page stands. */
import { LargeButton, toggleLarge, useLarge } from "../card/large.js";
import { useKeys } from "../keys/bindings.js";
import { useStore } from "../store.js";
import { html, useEffect, useMemo, useRef, useState } from "../view.js";
import { useAsleep } from "./asleep.js";
import { look, newViewer, openChannel } from "./channel.js";
import { FieldLegend, Layers, Views } from "./controls.js";
import { Frame } from "./frame.js";
import { drawsThreeDimensions } from "./webgl.js";

const HEAD_START_MS = 400;
const LIVE = "live";
const KEYS = [
  { key: "f", words: "Enlarge the scene, and back", act: () => toggleLarge("scene") },
  { key: "v", words: "Scene: look at the whole rig", act: () => look("overview") },
];

/** Picture and STOP come first: true once there is telemetry, a moment has passed and the place is in view. */
function useTurn(place) {
  const ready = useStore((state) => state.tick !== null);
  const [turn, setTurn] = useState(false);
  useEffect(() => {
    if (!ready) return undefined;
    const inView = new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && setTurn(true));
    // By its own name: the reference is emptied a moment before the timer is stopped.
    const frame = place.current;
    const timer = setTimeout(() => inView.observe(frame), HEAD_START_MS);
    return () => {
      clearTimeout(timer);
      inView.disconnect();
    };
  }, [ready]);
  return turn;
}

/**
 * @param {{session?: string | null, badge?: any, onWindow?: (target: Window) => void}} props session: of the replay that
 *        is shown, null while it is not known; badge: beside the title; onWindow: hears of the viewer's window
 */
export function Scene({ session = LIVE, badge = null, onWindow = () => {} }) {
  const place = useRef(null);
  const turn = useTurn(place);
  const asleep = useAsleep();
  const large = useLarge("scene");
  useKeys("Scene", KEYS);
  return html`
    <section class="card scene" aria-labelledby="scene-title" data-large=${large}>
      <header class="card-head"><h2 id="scene-title">Scene</h2>${badge}<${Views} /><${LargeButton} name="scene" what="the scene" /></header>
      <div class="scene-frame" ref=${place}>
        ${turn && !asleep && session !== null ? html`<${Viewer} session=${session} onWindow=${onWindow} />` : html`<p class="scene-note">Loading the 3D scene…</p>`}
      </div>
      <footer class="scene-foot"><${Layers} /><${FieldLegend} /></footer>
    </section>
  `;
}

function Viewer({ session, onWindow }) {
  const viewer = useMemo(newViewer, []);
  const able = useMemo(drawsThreeDimensions, []);
  useEffect(() => (able ? openChannel(viewer) : undefined), []);
  if (!able) {
    return html`<p class="scene-note" role="status"><span>This browser cannot draw the 3D scene: WebGL 2 is missing. Switch on
      hardware acceleration in its settings, or open the page in another browser. Everything else here works without it.</span></p>`;
  }
  return html`<${Frame} address=${`/scene/${session}/${viewer}/`} onWindow=${onWindow} />`;
}
