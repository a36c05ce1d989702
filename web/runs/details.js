/** Everything about one run: beside the list, on a phone a sheet under the bar. */
import { closeReplay, openReplay } from "../replay/replay.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { DeleteDialog } from "./delete.js";
import { Downloads } from "./downloads.js";
import { Editing } from "./editing.js";
import { Facts } from "./facts.js";
import { Figure } from "./figure.js";
import { closeDetails, inspect, pin, runAgain, useInspected, wholeRun } from "./inspected.js";
import { NOT_PINNED, Pin, PINNED } from "./pin.js";
import { Differences, Settings } from "./settings.js";
import { SHEET } from "./sheet.js";
import { exactly, nameOf, partName, remarks, whyNothingToReplay } from "./words.js";

export function Details() {
  const inspected = useInspected();
  const title = useRef(null);
  // A sheet covers the list: the focus goes to it.
  useEffect(() => void (SHEET.matches && title.current?.focus()), []);
  const run = inspected && wholeRun(inspected);
  if (!inspected) return null;
  return html`
    <aside class="run-details" aria-labelledby="run-details-title">
      <header class="card-head">
        <h3 id="run-details-title" ref=${title} tabindex="-1">${run ? nameOf(run) : inspected.id}</h3>
        ${run && html`<span class="run-state" data-state=${run.state}>${run.state}</span><${PinButton} run=${run} working=${inspected.working} />`}
        <button class="quiet close" type="button" onClick=${closeDetails}>Close</button>
      </header>
      <div class="run-page">
        ${run ? html`<${Page} run=${run} inspected=${inspected} />` : html`<p class="hint" role="status">${inspected.error || "Loading…"}</p>`}
      </div>
    </aside>
  `;
}

function PinButton({ run, working }) {
  return html`
    <button class="quiet pin" type="button" aria-pressed=${Boolean(run.pinned)} aria-label="Pin this run" disabled=${working !== ""}
      title=${run.pinned ? PINNED : NOT_PINNED} onClick=${() => pin(run)}><${Pin} /></button>
  `;
}

function Page({ run, inspected }) {
  return html`
    <p class="hint">${partName(run.controller)} on ${partName(run.trajectory)}, ${exactly(run.started_at)}${run.label ? html`<br /><code>${run.id}</code>` : ""}
      ${run.simulated && html` <span class="badge">SIM</span>`}</p>
    ${remarks(run).map((text) => html`<p class="remark" key=${text}>${text}</p>`)}
    <${Buttons} run=${run} working=${inspected.working} />
    <div class="outcome" aria-live="polite">
      ${inspected.error && html`<p class="field-error">${inspected.error}</p>`}
      ${inspected.restarted && html`<${Restarted} ...${inspected.restarted} />`}
    </div>
    <${Facts} run=${run} />
    <${Figure} run=${run} />
    <${Editing} key=${run.id} run=${run} />
    <${Settings} run=${run} />
  `;
}

function Buttons({ run, working }) {
  const rig = useStore((state) => state.tick?.rig);
  const [asking, ask] = useState(false);
  const unsaved = whyNothingToReplay(run);
  const notNow = whyNotAgain(rig);
  const kept = whyNotDeleted(run);
  return html`
    <div class="run-buttons">
      <button class="next" type="button" disabled=${unsaved !== ""} title=${unsaved} onClick=${() => openReplay([run.id])}>Replay</button>
      <button type="button" disabled=${notNow !== "" || working !== ""} title=${notNow} onClick=${() => again(run)}>Run again</button>
      <${Downloads} run=${run} why=${unsaved} />
      <button type="button" disabled=${kept !== ""} title=${kept} onClick=${() => ask(true)}>Delete…</button>
    </div>
    <p class="hint">${notNow && `Run again: ${notNow}`}</p>
    ${asking && html`<${DeleteDialog} runs=${[run]} close=${() => ask(false)} />`}
  `;
}

/** What moves now is the rig, and no recording stands in its place. */
const again = async (run) => (await runAgain(run)) && closeReplay();

const NOT_AGAIN = {
  disarmed: "arm the rig first.",
  running: "a run goes on; it has to end first.",
  held: "the rig is on hold; resume it or end the run first.",
  fault: "the rig has a fault; reset and arm it first.",
};

const whyNotAgain = (rig) => (rig === "armed" ? "" : (NOT_AGAIN[rig] ?? "the rig is not known yet."));

function whyNotDeleted(run) {
  if (run.state === "running") return "It goes on; stop it first.";
  if (run.recording?.state === "writing") return "Its recording is being finished; a moment.";
  return run.pinned ? "It is pinned; unpin it first." : "";
}

/** The same run has begun anew; what of the rig is not as it was. */
function Restarted({ run, differences = [] }) {
  return html`
    <div class="pending">
      <p class="done"><span>Started again as ${run.id}.</span><button class="quiet" type="button" onClick=${() => inspect(run.id)}>Show it</button></p>
      ${differences.length > 0 && html`<p>The rig is not as it was then:</p><${Differences} differences=${differences} />`}
    </div>
  `;
}
