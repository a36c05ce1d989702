/** Four corners of a rectangle of known size, clicked in order and dragged until they fit. */
import { useStore } from "../store.js";
import { useLayer, usePointer } from "../camera/pointing.js";
import { html, useRef, useState } from "../view.js";
import { numbered, outline } from "./drawing.js";
import { Length } from "./length.js";
import { Do } from "./parts.js";

const ORDER = ["upper left", "upper right", "lower right", "lower left"];
const DEFAULT_SIDE_MM = 120;
/** A press this near to a point takes hold of it, CSS px. */
export const REACH = 18;

/** Points in the picture that a press adds, up to `most`, or takes hold of; it says whether of one that was there. */
export function usePoints(most) {
  const [points, setPoints] = useState([]);
  const held = useRef(-1);
  const put = (index, { u, v }) => setPoints((before) => before.map((point, other) => (other === index ? [u, v] : point)));
  const press = (place) => {
    held.current = points.findIndex(([u, v]) => Math.hypot(u - place.u, v - place.v) <= REACH * place.pixel);
    if (held.current >= 0 || points.length >= most) return held.current >= 0;
    held.current = points.length;
    setPoints([...points, [place.u, place.v]]);
    return false;
  };
  const move = (place) => held.current >= 0 && put(held.current, place);
  const release = () => void (held.current = -1);
  return { points, setPoints, press, move, release };
}

export function FourCorners({ solve, fresh }) {
  const workspace = useStore((state) => state.rig?.limits?.workspace_mm ?? DEFAULT_SIDE_MM);
  const [size, setSize] = useState({ width_mm: workspace, height_mm: workspace });
  const { points, setPoints, ...pointer } = usePoints(ORDER.length);
  const next = ORDER[points.length];
  usePointer({ words: next ? `Click the ${next} corner` : "Drag the corners until they fit", ...pointer });
  useLayer((pen) => {
    outline(pen, points, { open: points.length < ORDER.length });
    numbered(pen, points);
  }, [points]);
  const complete = points.length === ORDER.length && Object.values(size).every((side) => side > 0);
  return html`
    <p class="hint">Click the corners of a rectangle on the plate whose size you know, clockwise from the upper left one.</p>
    <div class="sides">
      <${Length} title="Width" value=${size.width_mm} onChange=${(value) => setSize({ ...size, width_mm: value })} />
      <${Length} title="Height" value=${size.height_mm} onChange=${(value) => setSize({ ...size, height_mm: value })} />
    </div>
    <ol class="points">
      ${ORDER.map((name, index) => html`<li data-set=${index < points.length}>${name}${index < points.length && html` <span class="soft">${placeWords(points[index])}</span>`}</li>`)}
    </ol>
    <div class="row">
      <${Do} primary=${fresh} disabled=${!complete} act=${() => solve({ method: "corners", points_px: points, ...size })}>Work out the plane<//>
      ${points.length > 0 && html`<${Do} quiet act=${() => setPoints([])}>Start again<//>`}
    </div>
  `;
}

export const placeWords = ([u, v]) => `${Math.round(u)}, ${Math.round(v)} px`;
