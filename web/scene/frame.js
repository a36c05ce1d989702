/** The server's own viewer in a frame of the same origin; it is begun anew when it has lost its connection. */
import { stopOnKeysIn } from "../keys/keys.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";

/** So long a viewer may take to begin on a slow computer, ms; each time it has not, twice as long. */
const PATIENCE_MS = 15000;
const LONGEST_PATIENCE_MS = 120000;
/** One that was connected and is not any more tries by itself only while it has the focus, ms. */
const RETURN_MS = 1500;

/** How often the frame has been begun anew, for want of a connection. */
function useRenewals(begun) {
  const watching = useStore((state) => state.scene.watching);
  const [renewals, setRenewals] = useState(0);
  const renew = () => setRenewals((count) => count + 1);
  const patience = useRef(PATIENCE_MS);
  useEffect(() => {
    if (watching) patience.current = RETURN_MS;
    if (!begun || watching !== false) return undefined;
    const timer = setTimeout(() => {
      patience.current = Math.min(Math.max(2 * patience.current, PATIENCE_MS), LONGEST_PATIENCE_MS);
      renew();
    }, patience.current);
    return () => clearTimeout(timer);
  }, [begun, watching, renewals]);
  return { renewals, renew };
}

/** @param {{address: string, onWindow: (target: Window) => void}} props onWindow: hears of the viewer's window */
export function Frame({ address, onWindow }) {
  const [loaded, setLoaded] = useState(false);
  const [drawn, setDrawn] = useState(false);
  const { renewals, renew } = useRenewals(loaded);
  const watching = useStore((state) => state.scene.watching);
  useEffect(() => {
    setLoaded(false);
    setDrawn(false);
  }, [renewals]);
  // What has been drawn stays to be seen while the connection is away, greyed with the rest of the page.
  useEffect(() => void (watching && setDrawn(true)), [watching, renewals]);
  const load = (event) => {
    const target = event.target.contentWindow;
    setLoaded(true);
    // The browser's own page of an error stands there: it belongs to nobody, and has no keys.
    if (event.target.contentDocument === null) return;
    stopOnKeysIn(target);
    // The graphics card has been taken away, as by a driver that starts again: what was drawn is gone.
    target.addEventListener("webglcontextlost", renew, { capture: true, once: true });
    onWindow(target);
  };
  return html`
    ${!drawn && html`<p class="scene-note">${loaded && renewals > 0 ? "The 3D scene does not connect; it is tried again." : "Loading the 3D scene…"}</p>`}
    <iframe key=${renewals} src=${address} title="3D scene of coils, field and robot" data-drawn=${drawn} onLoad=${load}></iframe>
  `;
}
