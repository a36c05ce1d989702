/** Beside the picture while a recording is shown, in place of the buttons of the rig: what came of the run. */
import { fixed, quantity } from "../units.js";
import { html } from "../view.js";
import { lasted } from "../runs/words.js";
import { seek } from "./player.js";
import { useReplay } from "./replay.js";
import { Badge, difference, Line, stamp } from "./signs.js";

/** @type {[title: string, unit: string, digits: number, of: (run: any) => number | undefined][]} */
const FIGURES = [
  ["Mean error", "mm", 2, ({ metrics }) => metrics?.mean_error_mm],
  ["Largest error", "mm", 2, ({ metrics }) => metrics?.max_error_mm],
  ["RMS error", "mm", 2, ({ metrics }) => metrics?.rms_error_mm],
  ["ME", "", 3, ({ metrics }) => metrics?.normalized_mean_error],
  ["Error at the end", "mm", 2, ({ metrics }) => metrics?.end_error_mm],
  ["Travelled", "mm", 0, ({ metrics }) => metrics?.travelled_mm],
  ["Duration", "s", 1, ({ metrics }) => metrics?.duration_s],
  ["Steps", "", 0, ({ metrics }) => metrics?.steps],
  ["Sweeps", "", 0, ({ metrics }) => metrics?.sweeps],
  ["Reversals", "", 0, ({ metrics }) => metrics?.reversals],
  ["Sweep", "°", 0, ({ gait }) => gait?.sweep_deg],
  ["Tilt", "°", 0, ({ gait }) => gait?.tilt_deg],
];

export function ReplayPanel() {
  const runs = useReplay((replay) => replay.runs) ?? [];
  return html`
    <section class="card run replay-panel" aria-labelledby="recording-title">
      <header class="card-head"><h2 id="recording-title">${runs.length > 1 ? "Two recordings" : "Recording"}</h2><${Badge} /></header>
      ${runs.length > 0 && html`<div class="replay-panel-body"><${Outcome} runs=${runs} /><${Figures} runs=${runs} /><${Events} runs=${runs} /></div>`}
    </section>
  `;
}

function Outcome({ runs }) {
  return html`
    <dl class="outcomes">
      ${runs.map(({ id, name, run }, index) => html`
        <div key=${id}><dt>${runs.length > 1 && html`<${Line} index=${index} />`}${name}</dt><dd><span class="run-${run.state}">${run.state}</span>${run.reason && html` <span class="soft">${run.reason}</span>`}</dd></div>
      `)}
    </dl>
  `;
}

function Figures({ runs }) {
  const two = runs.length > 1;
  return html`
    <table class="replay-figures">
      <caption class="unseen">${two ? "Figures of both runs and their difference" : "Figures of the run"}</caption>
      ${two && html`<thead><tr><th scope="col"><span class="unseen">Figure</span></th>
        ${runs.map(({ id, name }, index) => html`<th scope="col" key=${id} title=${name}><${Line} index=${index} /><span class="unseen">${name}</span></th>`)}
        <th scope="col">Difference</th></tr></thead>`}
      <tbody>${FIGURES.map(([title, unit, digits, of]) => html`
        <tr><th scope="row">${title}${two && unit && html` <span class="soft">${unit}</span>`}</th>
          ${runs.map(({ id, run }) => html`<td key=${id}>${two ? fixed(of(run), digits) : oneFigure(of(run), unit, digits)}</td>`)}
          ${two && html`<td>${difference(of(runs[0].run), of(runs[1].run), digits)}</td>`}
        </tr>`)}
      </tbody>
    </table>
  `;
}

const oneFigure = (value, unit, digits) => (unit === "s" ? lasted(value) : unit ? quantity(value, unit, digits) : fixed(value, digits));

/** A click goes to where it happened. */
function Events({ runs }) {
  const events = runs.flatMap(({ events: of }, index) => of.map((event) => ({ ...event, run: index })));
  events.sort((one, other) => one.time_s - other.time_s);
  return html`
    <h3>Events</h3>
    ${events.length === 0 && html`<p class="hint">None was recorded.</p>`}
    <ol class="replay-events">
      ${events.map((event) => html`
        <li data-severity=${event.severity}>
          <button class="quiet" type="button" title=${event.code} onClick=${() => seek(event.time_s)}>
            <span class="event-time">${runs.length > 1 && html`<${Line} index=${event.run} />`}${stamp(event.time_s)}</span><span>${event.message}</span>
          </button>
        </li>
      `)}
    </ol>
  `;
}
