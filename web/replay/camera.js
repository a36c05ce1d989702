/** The camera card while a recording is shown: its pictures with their overlay, of two runs beside each other. */
import { Readings } from "../camera/camera.js";
import { createPainter } from "../camera/painter.js";
import { html, useEffect, useMemo, useRef, useState } from "../view.js";
import { answer, look, onAnswer } from "./line.js";
import { atTextPace, useTime } from "./player.js";
import { recordedPictures } from "./pictures.js";
import { mayHavePictures } from "./recording.js";
import { useReplay } from "./replay.js";
import { Badge, Line } from "./signs.js";

export function ReplayCamera() {
  const runs = useReplay((replay) => replay.runs) ?? [];
  const [overlay, setOverlay] = useState(true);
  return html`
    <section class="card camera" aria-labelledby="camera-title">
      <header class="card-head">
        <h2 id="camera-title">Camera</h2><${Badge} />
        <label class="switch"><input type="checkbox" checked=${overlay} onChange=${(event) => setOverlay(event.target.checked)} />Overlay</label>
      </header>
      <div class="pictures" data-count=${runs.length}>
        ${runs.map((run, index) => html`<${Picture} key=${run.id} index=${index} run=${run} overlay=${overlay} alone=${runs.length === 1} />`)}
      </div>
      ${runs.map((run, index) => html`<${RecordedReadings} key=${run.id} index=${index} alone=${runs.length === 1} />`)}
    </section>
  `;
}

function Picture({ index, run, overlay, alone }) {
  const canvas = useRef(null);
  const painter = useRef(null);
  const source = useMemo(() => recordedPictures(index), [index, run]);
  useEffect(() => {
    painter.current = createPainter(canvas.current, source);
    return () => painter.current.close();
  }, [source]);
  useEffect(() => {
    const sight = new IntersectionObserver(([entry]) => look(index, entry.isIntersecting));
    sight.observe(canvas.current);
    return () => {
      sight.disconnect();
      look(index, true);
    };
  }, [index]);
  useEffect(() => painter.current.show({ view: "raw", overlay }), [source, overlay]);
  const label = `Recorded camera picture of ${run.name}, with the robot, its path and its target`;
  return html`
    <div class="picture">
      <canvas ref=${canvas} role="img" aria-label=${label}></canvas>
      ${!alone && html`<p class="picture-name"><${Line} index=${index} />${run.name}</p>`}
      <div class="picture-notes foot"><${Note} run=${run} /></div>
    </div>
  `;
}

function Note({ run }) {
  const time = useTime();
  if (time > run.duration_s) return html`<p class="picture-note">this run was over at ${run.duration_s.toFixed(1)} s</p>`;
  return mayHavePictures(run) ? null : html`<p class="picture-note">no pictures were recorded</p>`;
}

const onTextAnswer = atTextPace(onAnswer);

/** The tick of one run at the pace of text. */
function useRecordedTick(index) {
  const [tick, show] = useState(answer.ticks[index] ?? null);
  useEffect(() => onTextAnswer(() => show(answer.ticks[index] ?? null)), [index]);
  return tick;
}

function RecordedReadings({ index, alone }) {
  const tick = useRecordedTick(index);
  return html`<div class="recorded-readings">${!alone && html`<${Line} index=${index} />`}<${Readings} tick=${tick} waiting="–" /></div>`;
}
