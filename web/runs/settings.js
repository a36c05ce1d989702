/** The settings that made a run, folded, with what of them is different on the rig now. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { differencesOf, flattened } from "./differences.js";

/** Of what is known of the conditions (README, "Recordings"): in a line each, and folded. */
const PLAIN = [["revision", "revision"], ["plant", "simulated robot"], ["seed", "seed"], ["study", "study"]];
const FOLDED = [["rig", "Rig file"], ["camera", "Camera model"], ["versions", "Versions"], ["computer", "Computer"]];

export function Settings({ run }) {
  const rig = useStore((state) => state.rig);
  const then = run.settings?.rig ?? null;
  const differences = then && rig ? differencesOf(then, rig) : [];
  return html`
    <details class="more">
      <summary>Settings of this run <span class="soft">${then && (differences.length > 0 ? `${differences.length} differ from the rig now` : "as the rig is now")}</span></summary>
      ${differences.length > 0 && html`<${Differences} differences=${differences} />`}
      <${Part} title="Controller" part=${run.controller} /><${Part} title="Trajectory" part=${run.trajectory} />
      <h4>Program</h4>
      <${Values} values=${PLAIN.map(([name, title]) => [title, run.settings?.[name]]).filter(([, value]) => value !== undefined && value !== null && value !== "")} />
      ${FOLDED.map(([name, title]) => run.settings?.[name] && html`<${Section} key=${name} title=${title} value=${run.settings[name]} />`)}
    </details>
  `;
}

function Part({ title, part }) {
  const parameters = Object.entries(flattened(part?.parameters ?? {}));
  if (!part) return null;
  return html`
    <h4>${title}: ${part.name ?? part}</h4>
    <${Values} values=${parameters} />
  `;
}

function Section({ title, value }) {
  return html`<details class="more"><summary>${title}</summary><${Values} values=${Object.entries(flattened(value))} /></details>`;
}

function Values({ values }) {
  return html`<dl class="settings-values">${values.map(([name, value]) => html`<div key=${name}><dt>${name}</dt><dd>${shown(value)}</dd></div>`)}</dl>`;
}

/** [{name, then, now}] */
export function Differences({ differences }) {
  return html`
    <table class="differences">
      <thead><tr><th scope="col">Setting</th><th scope="col">Then</th><th scope="col">Now</th></tr></thead>
      <tbody>${differences.map(({ name, then, now }) => html`<tr key=${name}><td>${name}</td><td>${shown(then)}</td><td>${shown(now)}</td></tr>`)}</tbody>
    </table>
  `;
}

const LONGEST = 400;

function shown(value) {
  if (value === null || value === undefined || value === "") return "–";
  const text = typeof value === "string" ? value : JSON.stringify(value);
  return text.length > LONGEST ? `${text.slice(0, LONGEST)}…` : text;
}
