/** The 3D scene: the server's own viewer in a frame of the same origin, loaded once the page stands. */
import { stopOnKeysIn } from "../keys/keys.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";

const HEAD_START_MS = 400;
const DARK = matchMedia("(prefers-color-scheme: dark)");

/** The viewer itself knows `darkMode`. */
function addressOf(query) {
  const words = new URLSearchParams(query).toString();
  return ["/scene/", [words, DARK.matches ? "darkMode" : ""].filter(Boolean).join("&")].filter(Boolean).join("?");
}

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
 * @param props query: of the viewer's address, null while it is not known; badge: beside the title; onWindow: hears
 *        of the viewer's window once it stands
 */
export function Scene({ query = {}, badge = null, onWindow = () => {} }) {
  const place = useRef(null);
  const turn = useTurn(place);
  const [loaded, setLoaded] = useState(false);
  const load = (event) => {
    setLoaded(true);
    stopOnKeysIn(event.target.contentWindow);
    onWindow(event.target.contentWindow);
  };
  return html`
    <section class="card scene" aria-labelledby="scene-title">
      <header class="card-head"><h2 id="scene-title">Scene</h2>${badge}<span class="hint">drag to turn, scroll to zoom</span></header>
      <div class="scene-frame" ref=${place}>
        ${!loaded && html`<p class="scene-note">Loading the 3D scene…</p>`}
        ${turn && query && html`<iframe src=${addressOf(query)} title="3D scene of coils, field and robot" onLoad=${load}></iframe>`}
      </div>
    </section>
  `;
}
