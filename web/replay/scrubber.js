/** The whole run at a glance, to be scrubbed: the curve of its error, what happened in it, and where the replay is. */
import { quantity } from "../units.js";
import { html, useEffect, useMemo, useRef } from "../view.js";
import { hold, letGo, now_s, onTime, seek, seekBy, useTime } from "./player.js";
import { useReplay } from "./replay.js";
import { stamp } from "./signs.js";

/** Units across and up the drawing of the curve. */
const WIDTH = 1000;
const HEIGHT = 100;
/** As many columns as a wide screen tells apart. */
const COLUMNS = 500;
/** More marks than this would be a wall. */
const MOST_MARKS = 200;
const STEPS_S = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };

export function Scrubber() {
  const runs = useReplay((replay) => replay.runs) ?? [];
  const duration = useReplay((replay) => replay.duration_s) ?? 0;
  return html`
    <div class="scrubber">
      <div class="scrubber-curve"><${Curves} runs=${runs} duration=${duration} /><${Loop} duration=${duration} /></div>
      <${Thumb} duration=${duration} />
      <${Marks} runs=${runs} duration=${duration} />
    </div>
  `;
}

function Curves({ runs, duration }) {
  const paths = useMemo(() => curvesOf(runs, duration), [runs, duration]);
  return html`
    <svg viewBox=${`0 0 ${WIDTH} ${HEIGHT}`} preserveAspectRatio="none" aria-hidden="true">
      ${paths.map((path, index) => html`<path d=${path} data-run=${index} />`)}
    </svg>
  `;
}

/** SVG paths of the errors on one scale, largest of each column, so that no peak is lost. */
function curvesOf(runs, duration) {
  const highest = Math.max(1e-9, ...runs.map(({ series }) => largest(series.error_mm)));
  return runs.map(({ series }) => {
    const peaks = peaksOf(series, duration);
    let pen = "M";
    return peaks.map((peak, column) => {
      if (peak === null) pen = "M";
      if (typeof peak !== "number") return "";
      const point = `${pen}${((column + 0.5) * WIDTH) / peaks.length},${(HEIGHT * (1 - 0.92 * (peak / highest))).toFixed(1)}`;
      pen = "L";
      return point;
    }).join("");
  });
}

const largest = (values) => values.reduce((most, value) => (value > most ? value : most), 0);

/** null: the error was not known then; undefined: no value falls into this column. */
function peaksOf({ time_s, error_mm }, duration) {
  const peaks = new Array(Math.max(2, Math.min(COLUMNS, time_s.length))).fill(undefined);
  time_s.forEach((time, index) => {
    const column = Math.min(peaks.length - 1, Math.floor((time / duration) * peaks.length));
    if (column >= 0 && !(peaks[column] >= error_mm[index])) peaks[column] = error_mm[index] ?? peaks[column] ?? null;
  });
  return peaks;
}

const share = (time, duration) => `${(100 * Math.min(1, Math.max(0, time / duration))).toFixed(3)}%`;

function Loop({ duration }) {
  const loop = useReplay((replay) => replay.loop);
  if (!loop) return null;
  return html`<span class="scrubber-loop" style=${{ left: share(loop[0], duration), right: `calc(100% - ${share(loop[1], duration)})` }}><i>A</i><i>B</i></span>`;
}

/** A slider for mouse, finger and arrow keys; its line follows the time without the page being drawn anew. */
function Thumb({ duration }) {
  const track = useRef(null);
  const line = useRef(null);
  const time = useTime();
  useEffect(() => {
    const { style } = line.current;
    const place = (at) => void (style.left = share(at, duration));
    place(now_s());
    return onTime(place);
  }, [duration]);
  const timeAt = (event) => {
    const box = track.current.getBoundingClientRect();
    return ((event.clientX - box.left) / box.width) * duration;
  };
  const press = (event) => {
    if (event.button !== 0) return;
    track.current.setPointerCapture(event.pointerId);
    hold();
    seek(timeAt(event));
  };
  const drag = (event) => track.current.hasPointerCapture(event.pointerId) && seek(timeAt(event));
  const key = (event) => {
    const ends = { Home: 0, End: duration };
    if (event.key in STEPS_S) seekBy(STEPS_S[event.key]);
    else if (event.key in ends) seek(ends[event.key]);
    else return;
    event.preventDefault();
  };
  useEffect(() => letGo, []);
  return html`
    <div class="scrubber-track" ref=${track} role="slider" tabindex="0" aria-label="Time in the recording" aria-valuemin="0" aria-valuemax=${duration.toFixed(1)}
      aria-valuenow=${time.toFixed(1)} aria-valuetext=${`${stamp(time)} of ${stamp(duration)}`}
      onPointerDown=${press} onPointerMove=${drag} onPointerUp=${letGo} onPointerCancel=${letGo} onLostPointerCapture=${letGo} onKeyDown=${key}>
      <span class="scrubber-line" ref=${line}></span>
    </div>
  `;
}

/** What happened: hovering says it, a click goes there. The keyboard finds the same in the list of events. */
function Marks({ runs, duration }) {
  const marks = runs.flatMap((run, index) => run.events.slice(0, MOST_MARKS).map((event) => ({ ...event, run: index })));
  return html`
    <div class="scrubber-marks" aria-hidden="true">
      ${marks.map((mark) => html`
        <button type="button" tabindex="-1" data-severity=${mark.severity} data-run=${mark.run} style=${{ left: share(mark.time_s, duration) }}
          title=${`${quantity(mark.time_s, "s")}: ${mark.message}`} onClick=${() => seek(mark.time_s)}></button>
      `)}
    </div>
  `;
}
