/** The list: a row a run, on a phone a card a run. Enter opens, the arrows go from row to row. */
import { fixed } from "../units.js";
import { html, useMemo } from "../view.js";
import { inspect, pinInList, rowId, toggleDetails } from "./inspected.js";
import { tick } from "./listing.js";
import { NOT_PINNED, Pin, PINNED } from "./pin.js";
import { Sparkline } from "./sparkline.js";
import { bytes, exactly, lasted, nameOf, partName, when } from "./words.js";

/**
 * The name says where CSS leaves it out when there is little room.
 * @type {[name: string, title: string, unit: string, cell: (run: any, open: boolean) => any][]}
 */
const COLUMNS = [
  ["started", "Started", "", (run) => html`<time datetime=${run.started_at} title=${exactly(run.started_at)}>${when(run.started_at)}</time>`],
  ["name", "Run", "", (run, open) => html`<${Name} run=${run} open=${open} />`],
  ["state", "State", "", (run) => html`<span class="run-state" data-state=${run.state} title=${run.reason}>${run.state}</span>`],
  ["error", "Error", "", (run) => html`<${Sparkline} values=${run.sparkline} />`],
  ["controller", "Controller", "", (run) => partName(run.controller)],
  ["trajectory", "Trajectory", "", (run) => partName(run.trajectory)],
  ["sweep", "Sweep", "°", (run) => fixed(run.gait?.sweep_deg, 0)],
  ["tilt", "Tilt", "°", (run) => fixed(run.gait?.tilt_deg, 0)],
  ["mean", "Mean error", "mm", (run) => fixed(run.metrics?.mean_error_mm, 2)],
  ["share", "ME", "", (run) => fixed(run.metrics?.normalized_mean_error, 3)],
  ["duration", "Duration", "", (run) => lasted(run.metrics?.duration_s)],
  ["size", "Size", "", (run) => (run.recording?.size_bytes ? bytes(run.recording.size_bytes) : "–")],
];

const TITLES = { share: "Mean error as a share of the robot's length", error: "The error over the run, each to its own largest value" };

export function Table({ runs, ticked, opened }) {
  return html`
    <table class="runs-table" role="table" onKeyDown=${walk}>
      <caption class="unseen">Runs, newest first</caption>
      <thead role="rowgroup"><tr role="row">
        <th scope="col" role="columnheader" data-column="tick"><span class="unseen">Ticked</span></th>
        ${COLUMNS.map(([name, title, unit]) => html`
          <th scope="col" role="columnheader" data-column=${name} title=${TITLES[name]}>${title}${unit && html` <span class="soft">${unit}</span>`}</th>
        `)}
        <th scope="col" role="columnheader" data-column="pin"><span class="unseen">Pinned</span></th>
      </tr></thead>
      <tbody role="rowgroup">${runs.map((run) => html`<${Row} key=${run.id} run=${run} open=${run.id === opened} ticked=${ticked.includes(run.id)} />`)}</tbody>
    </table>
  `;
}

/** Made anew only when something of it has changed: a list may have grown to thousands of rows. */
function Row({ run, open, ticked }) {
  return useMemo(() => row(run, open, ticked), [run, open, ticked]);
}

function row(run, open, ticked) {
  const choose = (event) => !event.target.closest("button, input, label") && inspect(run.id);
  return html`
    <tr role="row" data-open=${open} data-run=${run.id} onClick=${choose}>
      <td role="cell" data-column="tick"><${Tick} run=${run} ticked=${ticked} /></td>
      ${COLUMNS.map(([name, , , cell]) => html`<${Cell} name=${name} content=${cell(run, open)} />`)}
      <td role="cell" data-column="pin">
        <button class="quiet pin" type="button" aria-pressed=${Boolean(run.pinned)} aria-label=${`Pin ${nameOf(run)}`}
          title=${run.pinned ? PINNED : NOT_PINNED} onClick=${() => pinInList(run)}>
          <${Pin} />
        </button>
      </td>
    </tr>
  `;
}

const Cell = ({ name, content }) => html`<td role="cell" data-column=${name} data-empty=${content === "–"}>${content}</td>`;

function Name({ run, open }) {
  const tags = run.tags ?? [];
  return html`
    <button class="run-name" type="button" id=${rowId(run.id)} aria-expanded=${open} title=${run.label ? `${run.label}, ${run.id}` : run.id} onClick=${() => toggleDetails(run.id)}>
      ${nameOf(run)}
    </button>
    ${tags.length > 0 && html`<span class="run-tags" title=${tags.join(", ")}>${tags.join(" · ")}</span>`}
  `;
}

/** The space bar is STOP, so Enter ticks. */
function Tick({ run, ticked }) {
  const set = (event) => tick(run.id, event.target.checked);
  const press = (event) => event.key === "Enter" && tick(run.id, !ticked);
  return html`<label class="tick"><input type="checkbox" aria-label=${`Select ${nameOf(run)}`} checked=${ticked} onChange=${set} onKeyDown=${press} /></label>`;
}

/** Up and down between the names, as in a list of files. */
function walk(event) {
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!step || !event.target.matches(".run-name")) return;
  const names = [...event.currentTarget.querySelectorAll(".run-name")];
  const next = names[names.indexOf(event.target) + step];
  if (!next) return;
  event.preventDefault();
  next.focus();
}
