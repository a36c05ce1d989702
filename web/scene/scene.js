/** The 3D scene: the server's own viewer in a frame of the same origin, loaded once the page stands. */
import { stopOnKeysIn } from "../keys/keys.js";
import { useStore } from "../store.js";
import { html, useEffect, useState } from "../view.js";

/** Waits for the first telemetry and an idle moment: picture and STOP come first. */
function useTurn() {
  const ready = useStore((state) => state.tick !== null);
  const [turn, setTurn] = useState(false);
  useEffect(() => {
    if (!ready) return undefined;
    const timer = setTimeout(() => setTurn(true), 400);
    return () => clearTimeout(timer);
  }, [ready]);
  return turn;
}

export function Scene() {
  const turn = useTurn();
  const [loaded, setLoaded] = useState(false);
  const load = (event) => {
    setLoaded(true);
    stopOnKeysIn(event.target.contentWindow);
  };
  return html`
    <section class="card scene" aria-labelledby="scene-title">
      <header class="card-head"><h2 id="scene-title">Scene</h2><span class="hint">drag to turn, scroll to zoom</span></header>
      <div class="scene-frame">
        ${!loaded && html`<p class="scene-note">Loading the 3D scene…</p>`}
        ${turn && html`<iframe src="/scene/" title="3D scene of coils, field and robot" onLoad=${load}></iframe>`}
      </div>
    </section>
  `;
}
