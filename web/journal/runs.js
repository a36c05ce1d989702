/** This session's runs, newest first, with what came of them. */
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html } from "../view.js";

const COLUMNS = [
  ["Started", "", (run) => startedAt(run)],
  ["Run", "", (run) => run.label || run.id],
  ["State", "", (run) => run.state],
  ["Controller", "", (run) => nameOf(run.controller)],
  ["Trajectory", "", (run) => nameOf(run.trajectory)],
  ["Sweep", "°", (run) => fixed(run.gait?.sweep_deg, 0)],
  ["Mean error", "mm", (run) => fixed(run.metrics?.mean_error_mm, 2)],
  ["Largest", "mm", (run) => fixed(run.metrics?.max_error_mm, 2)],
  ["Mean / length", "", (run) => fixed(run.metrics?.normalized_mean_error, 3)],
  ["Steps", "", (run) => run.metrics?.steps ?? "–"],
  ["Travelled", "mm", (run) => fixed(run.metrics?.travelled_mm, 0)],
  ["Duration", "s", (run) => fixed(run.metrics?.duration_s, 1)],
];

const nameOf = (part) => (typeof part === "string" ? part : (part?.name ?? "–"));

function startedAt({ started_at: text }) {
  const time = new Date(text);
  return Number.isNaN(time.getTime()) ? "–" : time.toLocaleTimeString([], { hour12: false });
}

export function Runs() {
  const runs = useStore((state) => state.runs);
  if (runs.length === 0) return html`<p class="hint padded">No run yet in this session. Arm the rig and start one.</p>`;
  return html`
    <table>
      <caption class="unseen">Runs of this session, newest first</caption>
      <thead><tr>${COLUMNS.map(([title, unit]) => html`<th scope="col">${title}${unit && html` <span class="soft">${unit}</span>`}</th>`)}</tr></thead>
      <tbody>${runs.map((run) => html`
        <tr key=${run.id}>${COLUMNS.map(([title, , cell]) => html`<td class=${title === "State" ? `run-${run.state}` : ""}>${cell(run)}</td>`)}</tr>
      `)}</tbody>
    </table>
  `;
}
