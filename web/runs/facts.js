/** What came of a run, in figures. */
import { fixed, quantity } from "../units.js";
import { html } from "../view.js";
import { bytes, lasted } from "./words.js";

/** [title, words of a run, what it means] */
const FACTS = [
  ["Mean error", ({ metrics }) => quantity(metrics.mean_error_mm, "mm", 3), "Mean distance from the centre to the target"],
  ["ME", ({ metrics }) => fixed(metrics.normalized_mean_error, 4), "Mean error as a share of the robot's length"],
  ["RMS error", ({ metrics }) => quantity(metrics.rms_error_mm, "mm", 3), "Root of the mean square of the error"],
  ["Largest error", ({ metrics }) => quantity(metrics.max_error_mm, "mm", 3), ""],
  ["Error at the end", ({ metrics }) => quantity(metrics.end_error_mm, "mm", 3), ""],
  ["Travelled", ({ metrics }) => quantity(metrics.travelled_mm, "mm", 1), "Way of the robot's centre"],
  ["Duration", ({ metrics }) => lasted(metrics.duration_s), "Time of the rig"],
  ["Steps", ({ metrics }) => metrics.steps, "Switches from one pivot to the other"],
  ["Sweeps", ({ metrics }) => metrics.sweeps, ""],
  ["Reversals", ({ metrics }) => metrics.reversals, "Changes of the direction of walking"],
  ["Ticks", ({ metrics }) => metrics.ticks?.toLocaleString("en"), "Camera frames that went through the loop"],
];

const GAIT = [
  ["Sweep", ({ gait }) => quantity(gait.sweep_deg, "deg", 1)],
  ["Tilt", ({ gait }) => quantity(gait.tilt_deg, "deg", 1)],
  ["Field", ({ gait }) => quantity(gait.field_mT, "mT", 2)],
  ["Largest rate", ({ gait }) => quantity(gait.max_rate_deg_s, "deg/s", 0)],
  ["Path step", ({ gait }) => quantity(gait.path_step_s, "s", 2)],
];

const RECORDING = [
  ["Recording", ({ recording }) => (recording.size_bytes ? bytes(recording.size_bytes) : recording.state)],
  ["Pictures", ({ recording }) => recording.frames?.toLocaleString("en")],
];

const UNKNOWN = "–";

export function Facts({ run }) {
  const shown = [...(run.metrics ? FACTS : []), ...(run.gait ? GAIT : []), ...(run.recording ? RECORDING : [])]
    .map(([title, words, meaning]) => [title, words(run), meaning])
    .filter(([, words]) => words !== undefined && words !== null && !String(words).startsWith(UNKNOWN));
  return html`
    <dl class="run-facts">
      ${shown.map(([title, words, meaning]) => html`<div key=${title} title=${meaning}><dt>${title}</dt><dd>${words}</dd></div>`)}
    </dl>
  `;
}
