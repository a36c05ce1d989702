/** Marks on the plate whose places are known, each clicked in the picture and named in mm. */
import { useLayer, usePointer } from "../camera/pointing.js";
import { html, useState } from "../view.js";
import { placeWords, usePoints } from "./corners.js";
import { numbered } from "./drawing.js";
import { Length } from "./length.js";
import { Do } from "./parts.js";

const FEWEST = 4;
const MOST = 40;
const UNKNOWN = { x_mm: null, y_mm: null };

export function Marks({ solve, fresh }) {
  const { points, setPoints, ...pointer } = usePoints(MOST);
  const [places, setPlaces] = useState([]);
  usePointer({ words: `Click mark ${points.length + 1}`, ...pointer });
  useLayer((pen) => numbered(pen, points), [points]);
  const placeAt = (index) => places[index] ?? UNKNOWN;
  const name = (index, part) => setPlaces(points.map((_, other) => (other === index ? { ...placeAt(index), ...part } : placeAt(other))));
  const marks = points.map(([u, v], index) => ({ u, v, ...placeAt(index) }));
  const complete = marks.length >= FEWEST && marks.every(({ x_mm: x, y_mm: y }) => x !== null && y !== null);
  const startAgain = () => {
    setPoints([]);
    setPlaces([]);
  };
  return html`
    <p class="hint">Click at least ${FEWEST} marks on the plate, better six or more, and say where each one is: x to the right and y up from the workspace’s centre.</p>
    <ol class="marks">
      ${points.map((point, index) => html`
        <li key=${index}>
          <span class="soft">${placeWords(point)}</span>
          <${Length} signed title=${`x of mark ${index + 1}`} value=${null} onChange=${(value) => name(index, { x_mm: value })} />
          <${Length} signed title=${`y of mark ${index + 1}`} value=${null} onChange=${(value) => name(index, { y_mm: value })} />
        </li>
      `)}
    </ol>
    <div class="row">
      <${Do} primary=${fresh} disabled=${!complete} act=${() => solve({ method: "marks", marks })}>Work out the plane<//>
      ${points.length > 0 && html`<${Do} quiet act=${startAgain}>Start again<//>`}
    </div>
  `;
}
