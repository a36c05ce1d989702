/** What came of a run, in figures. */
import { HelpButton } from "../help/button.js";
import { fixed, quantity } from "../units.js";
import { html } from "../view.js";
import { bytes, lasted } from "./words.js";

/** @typedef {[title: string, words: (run: any) => any, metric?: string]} Fact metric: as the help knows it */

/** @type {Fact[]} */
const FACTS = [
  ["Mean error", ({ metrics }) => quantity(metrics.mean_error_mm, "mm", 3), "mean_error_mm"],
  ["ME", ({ metrics }) => fixed(metrics.normalized_mean_error, 4), "normalized_mean_error"],
  ["RMS error", ({ metrics }) => quantity(metrics.rms_error_mm, "mm", 3), "rms_error_mm"],
  ["Largest error", ({ metrics }) => quantity(metrics.max_error_mm, "mm", 3), "max_error_mm"],
  ["Error at the end", ({ metrics }) => quantity(metrics.end_error_mm, "mm", 3), "end_error_mm"],
  ["Travelled", ({ metrics }) => quantity(metrics.travelled_mm, "mm", 1), "travelled_mm"],
  ["Duration", ({ metrics }) => lasted(metrics.duration_s)],
  ["Steps", ({ metrics }) => metrics.steps, "steps"],
  ["Sweeps", ({ metrics }) => metrics.sweeps, "sweeps"],
  ["Reversals", ({ metrics }) => metrics.reversals, "reversals"],
  ["Ticks", ({ metrics }) => metrics.ticks?.toLocaleString("en")],
];

/** @type {Fact[]} */
const GAIT = [
  ["Sweep", ({ gait }) => quantity(gait.sweep_deg, "deg", 1)],
  ["Tilt", ({ gait }) => quantity(gait.tilt_deg, "deg", 1)],
  ["Field", ({ gait }) => quantity(gait.field_mT, "mT", 2)],
  ["Fastest swing", ({ gait }) => quantity(gait.max_rate_deg_s, "deg/s", 0)],
  ["Path step", ({ gait }) => quantity(gait.path_step_s, "s", 2)],
];

/** @type {Fact[]} */
const RECORDING = [
  ["Recording", ({ recording }) => (recording.size_bytes ? bytes(recording.size_bytes) : recording.state)],
  ["Pictures", ({ recording }) => recording.frames?.toLocaleString("en")],
];

const UNKNOWN = "–";

export function Facts({ run }) {
  const shown = [...(run.metrics ? FACTS : []), ...(run.gait ? GAIT : []), ...(run.recording ? RECORDING : [])]
    .map(([title, words, metric]) => [title, words(run), metric])
    .filter(([, words]) => words !== undefined && words !== null && !String(words).startsWith(UNKNOWN));
  return html`
    <dl class="run-facts">
      ${shown.map(([title, words, metric]) => html`
        <div key=${title}><dt>${title}${metric && html`<${HelpButton} of="metrics" form=${{ name: metric, title }} />`}</dt><dd>${words}</dd></div>`)}
    </dl>
  `;
}
