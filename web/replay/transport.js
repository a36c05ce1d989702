/** Play, step, speed and the range that is played again and again. */
import { html } from "../view.js";
import { endLoop, loopFromHere, loopToHere, setSpeed, SPEEDS, step, toggle, useTime } from "./player.js";
import { useReplay } from "./replay.js";
import { speedWords, stamp } from "./signs.js";

export function Transport() {
  const playing = useReplay((replay) => replay.playing);
  return html`
    <div class="transport" role="group" aria-label="Playback">
      <button type="button" class="icon" aria-label="Step back" title="One picture back (,)" onClick=${() => step(-1)}><${Sign} path="M13 4v12L6 10zM4.5 4v12" /></button>
      <button type="button" class="icon play" aria-label=${playing ? "Pause" : "Play"} aria-keyshortcuts="K" title=${`${playing ? "Pause" : "Play"} (K; the space bar is STOP)`} onClick=${toggle}>
        <${Sign} path=${playing ? "M6.5 4v12M13.5 4v12" : "M6 3.5v13l10-6.5z"} heavy=${playing} />
      </button>
      <button type="button" class="icon" aria-label="Step on" title="One picture on (.)" onClick=${() => step(1)}><${Sign} path="M7 4v12l7-6zM15.5 4v12" /></button>
      <${Clock} />
      <${Speed} />
      <${Loop} />
    </div>
  `;
}

const Sign = ({ path, heavy = false }) => html`<svg viewBox="0 0 20 20" aria-hidden="true" data-heavy=${heavy}><path d=${path} /></svg>`;

function Clock() {
  const time = useTime();
  const duration = useReplay((replay) => replay.duration_s) ?? 0;
  return html`<span class="replay-clock" title="Time since the start of the run, min:s"><b>${stamp(time)}</b> <span class="soft">/ ${stamp(duration)}</span></span>`;
}

function Speed() {
  const speed = useReplay((replay) => replay.speed);
  return html`
    <select class="speed" aria-label="Speed" title="Speed" onChange=${(event) => setSpeed(Number(event.target.value))}>
      ${SPEEDS.map((each) => html`<option value=${each} selected=${each === speed}>${speedWords(each)}</option>`)}
    </select>
  `;
}

function Loop() {
  const loop = useReplay((replay) => replay.loop);
  return html`
    <span class="loop" role="group" aria-label="Loop">
      <button type="button" aria-pressed=${loop !== null} title="The loop begins here ([)" onClick=${loopFromHere}><span class="unseen">Loop from here: </span>A</button>
      <button type="button" aria-pressed=${loop !== null} title="The loop ends here (])" onClick=${loopToHere}><span class="unseen">Loop to here: </span>B</button>
      <button type="button" aria-label="No loop" title="Play the whole run again (\\)" disabled=${loop === null} onClick=${endLoop}>×</button>
    </span>
  `;
}
