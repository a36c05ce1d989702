/** Measures a distance on the plate: two clicks, and ends that can be moved. */
import { useLayer, usePointer } from "../camera/pointing.js";
import { projection, unprojection } from "../camera/projection.js";
import { get, useStore } from "../store.js";
import { quantity } from "../units.js";
import { html, useRef, useState } from "../view.js";
import { measured } from "./distance.js";

/** A press this near to an end takes hold of it, CSS px. */
const REACH = 18;
const COLOURS = { seam: "#10151b", line: "#f0e442" };
const WORDS = ["Click where to measure from", "Click where to measure to", "Drag an end to move it"];

export function MeasurePanel({ close }) {
  const [ends, setEnds] = useState([]);
  const calibrated = useStore((state) => state.camera?.calibrated ?? false);
  useEnds(ends, setEnds);
  useLayer((pen) => pen.project && draw(pen, ends), [ends]);
  return html`
    <section class="tool-panel" aria-label="Measure a distance">
      <div class="row">
        ${ends.length === 2 ? html`<${Figures} ...${measured(ends[0], ends[1])} />` : html`<p class="hint">Two clicks in the picture; the distance is that on the plate.</p>`}
        <span class="row push">
          ${ends.length > 0 && html`<button class="quiet" type="button" onClick=${() => setEnds([])}>Clear</button>`}
          <button class="quiet" type="button" onClick=${close}>Done</button>
        </span>
      </div>
      ${!calibrated && html`<p class="hint">The camera’s place is not calibrated: a camera that looks straight down at the middle of the plate is assumed.</p>`}
    </section>
  `;
}

function Figures({ distance_mm, dx_mm, dy_mm, angle_deg }) {
  return html`
    <dl class="measured" aria-live="polite">
      <div><dt>Distance</dt><dd>${quantity(distance_mm, "mm")}</dd></div>
      <div><dt>in x</dt><dd>${quantity(dx_mm, "mm")}</dd></div>
      <div><dt>in y</dt><dd>${quantity(dy_mm, "mm")}</dd></div>
      <div><dt>Angle</dt><dd>${quantity(angle_deg, "deg")}</dd></div>
    </dl>
  `;
}

/** A third click begins anew. */
function useEnds(ends, setEnds) {
  const held = useRef(-1);
  const before = useRef(ends);
  const onPlate = ({ u, v }) => {
    const { camera } = get();
    return camera && unprojection(camera.model)(u, v);
  };
  const endAt = (place) => {
    const { camera } = get();
    const seen = camera ? ends.map(([x, y]) => projection(camera.model)(x, y)) : [];
    return seen.findIndex(([u, v]) => Math.hypot(u - place.u, v - place.v) <= REACH * place.pixel);
  };
  const press = (place) => {
    const at = onPlate(place);
    if (!at) return false;
    before.current = ends;
    held.current = endAt(place);
    if (held.current >= 0) return true;
    const kept = ends.length === 2 ? [] : ends;
    held.current = kept.length;
    setEnds([...kept, at]);
    return false;
  };
  const move = (place) => {
    const at = onPlate(place);
    if (at && held.current >= 0) setEnds((now) => now.map((end, index) => (index === held.current ? at : end)));
  };
  const release = () => void (held.current = -1);
  const cancel = () => {
    release();
    setEnds(before.current);
  };
  usePointer({ words: WORDS[ends.length], press, move, release, cancel });
}

function draw({ context, pixel, project }, ends) {
  const seen = ends.map(([x, y]) => project(x, y));
  context.lineCap = "round";
  for (const [ink, width] of /** @type {[string, number][]} */ ([[COLOURS.seam, 4], [COLOURS.line, 2]])) {
    context.strokeStyle = ink;
    context.lineWidth = width * pixel;
    context.beginPath();
    seen.forEach(([u, v], index) => (index === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
    for (const [u, v] of seen) {
      context.moveTo(u + 6 * pixel, v);
      context.arc(u, v, 6 * pixel, 0, 2 * Math.PI);
    }
    context.stroke();
  }
  if (ends.length < 2) return;
  const [[u, v], [p, q]] = seen;
  label({ context, pixel }, quantity(measured(ends[0], ends[1]).distance_mm, "mm"), (u + p) / 2, (v + q) / 2 - 14 * pixel);
}

function label({ context, pixel }, text, u, v) {
  Object.assign(context, { textAlign: "center", textBaseline: "middle", font: `650 ${14 * pixel}px system-ui, sans-serif`, lineJoin: "round" });
  Object.assign(context, { lineWidth: 4 * pixel, strokeStyle: COLOURS.seam, fillStyle: COLOURS.line });
  context.strokeText(text, u, v);
  context.fillText(text, u, v);
}
