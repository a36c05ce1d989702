/** Looks at the pictures of a run again: with another tracker, filter or camera, or for another controller. */
import { Problem } from "../live/rest.js";
import { Field, SchemaForm } from "../forms/form.js";
import { defaultsOf } from "../forms/schema.js";
import { Ask } from "../ask.js";
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html, useEffect, useState } from "../view.js";
import { mayHavePictures } from "./recording.js";
import { useReplay } from "./replay.js";
import { findSecondLook, forget, giveUp, lookAgain } from "./retracked.js";
import { difference } from "./signs.js";

const COLOURS = { hue_deg: ["Hue", "°"], saturation: ["Saturation", ""], value: ["Brightness", ""] };
const FILTER = {
  measured_position_mm: ["Noise of a sighting's place", "mm"], measured_heading_deg: ["Noise of its heading", "°"],
  drift_position_mm: ["Drift at rest", "mm"], drift_heading_deg: ["Drift of the heading", "°"],
  slip_mm: ["Slip at a switch", "mm"], swing_share: ["Doubt of a swing", ""], loose_share: ["Doubt in the play", ""],
  actuation_delay_ms: ["Delay of the field", "ms"], backlash_deg: ["Play", "°"],
};

export function RetrackButton() {
  const [open, setOpen] = useState(false);
  const run = useReplay((replay) => (replay.runs.length === 1 ? replay.runs[0] : null));
  useEffect(() => void (run && findSecondLook(run.id)), [run?.id]);
  if (!run || !mayHavePictures(run)) return null;
  return html`
    <button class="replay-again" type="button" onClick=${() => setOpen(true)}>Look again…</button>
    ${open && html`<${RetrackDialog} run=${run} close=${() => setOpen(false)} />`}
  `;
}

function RetrackDialog({ run, close }) {
  const second = useReplay((replay) => replay.second) ?? null;
  const [wish, setWish] = useState({ rig: "then", vision: {}, estimator: {}, controller: null });
  const [error, setError] = useState("");
  const working = second?.stage === "working";
  const go = async () => {
    setError("");
    try {
      await lookAgain(run.id, wish);
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      setError(problem.message);
    }
  };
  return html`
    <${Ask} title="Look at the pictures again" close=${close}>
      <p class="hint">The recorded pictures are searched once more. The recording stays as it is.</p>
      <div class="second-look" aria-live="polite">
        ${error && html`<p class="field-error">${error}</p>`}
        ${working && html`<progress aria-label="Looked at so far" value=${second.progress} max="1"></progress>`}
        ${second?.stage === "failed" && html`<p class="field-error">${second.reason}</p>`}
        ${second?.stage === "done" && html`<${Comparison} comparison=${second.comparison} />`}
      </div>
      <${Wishes} run=${run} wish=${wish} setWish=${setWish} />
      <div class="choice">
        ${working
          ? html`<button type="button" onClick=${() => giveUp(run.id)}>Cancel</button>`
          : html`<button class="primary" type="button" data-first onClick=${go}>Look again</button>`}
        <button type="button" onClick=${close}>Close</button>
        ${second?.stage === "done" && html`<button class="quiet" type="button" onClick=${() => forget(run.id)}>Forget it</button>`}
      </div>
    <//>
  `;
}

const CONTROLLER = { name: "controller", title: "Controller asked", description: "", unit: "", kind: "choice" };
const NOBODY = "nobody";
const WHOSE = { name: "rig", title: "Settings", description: "What is not changed below.", unit: "", kind: "choice", choices: ["as they were", "as the rig has them now"] };

function Wishes({ run, wish, setWish }) {
  const rigNow = useStore((state) => state.rig);
  const controllers = useStore((state) => state.controllers);
  const base = (wish.rig === "now" ? rigNow : run.run.settings?.rig) ?? {};
  const entry = controllers.find(({ name }) => name === wish.controller?.name);
  const change = (part) => (name, value) => setWish({ ...wish, [part]: withValue(base[part], wish[part], name, value) });
  const choose = (chosen) => {
    const entry = controllers.find(({ title }) => title === chosen);
    setWish({ ...wish, controller: entry ? { name: entry.name, parameters: defaultsOf(entry.parameters) } : null });
  };
  const changeParameter = (name, value) => setWish({ ...wish, controller: { ...wish.controller, parameters: { ...wish.controller.parameters, [name]: value } } });
  return html`
    <div class="fields">
      <${Field} id="retrack.rig" form=${WHOSE} value=${WHOSE.choices[Number(wish.rig === "now")]}
        onChange=${(value) => setWish({ ...wish, rig: value === WHOSE.choices[1] ? "now" : "then" })} />
      <${Field} id="retrack.controller" form=${{ ...CONTROLLER, choices: [NOBODY, ...controllers.map(({ title }) => title)] }}
        value=${entry?.title ?? NOBODY} onChange=${choose} />
    </div>
    ${entry && html`<p class="hint">It is asked at each moment what it would do, and not obeyed.</p>
      <${SchemaForm} section="retrack.controller" schema=${entry.parameters} values=${wish.controller.parameters} onChange=${changeParameter} />`}
    <details class="more"><summary>Colour of the robot</summary>
      <${Numbers} part="vision" names=${COLOURS} base=${coloursOf(base.vision)} wish=${wish.vision} onChange=${change("vision")} /></details>
    <details class="more"><summary>Filter</summary>
      <${Numbers} part="estimator" names=${FILTER} base=${base.estimator ?? {}} wish=${wish.estimator} onChange=${change("estimator")} /></details>
  `;
}

/** Those of the profile in use. */
const coloursOf = (vision) => vision?.profiles?.[vision.profile] ?? vision ?? {};

/** A number in a field each; of a span, one for each end. */
function Numbers({ part, names, base, wish, onChange }) {
  const now = { ...base, ...wish };
  const forms = Object.entries(names).flatMap(([name, [title, unit]]) => {
    const form = { name, title, description: "", unit, kind: "number", optional: false };
    if (!Array.isArray(base[name])) return name in base ? [{ ...form, value: now[name] }] : [];
    return ["from", "to"].map((end, index) => ({ ...form, name: `${name}.${index}`, title: `${title} ${end}`, value: now[name][index] }));
  });
  return html`<div class="fields">${forms.map((form) => html`
    <${Field} key=${form.name} id=${`retrack.${part}.${form.name}`} form=${form} value=${form.value} onChange=${(value) => onChange(form.name, value)} />`)}</div>`;
}

/** "hue_deg.1" is the second number of hue_deg. */
function withValue(section, changed, dotted, value) {
  const [name, index] = dotted.split(".");
  if (index === undefined) return { ...changed, [name]: value };
  const span = [...(changed[name] ?? coloursOf(section)[name])];
  span[Number(index)] = value;
  return { ...changed, [name]: span };
}

/** @type {[title: string, digits: number, factor: number, unit: string, name: string][]} */
const THEN_AND_NOW = [
  ["Mean error", 3, 1, "mm", "mean_error_mm"],
  ["Robot known", 1, 100, "%", "known_share"],
  ["Seen in pictures", 1, 100, "%", "locked_share"],
  ["Times lost", 0, 1, "", "times_lost"],
  ["Sightings refused", 0, 1, "", "sightings_refused"],
];

function Comparison({ comparison }) {
  const { position_mm: place, heading_deg: heading, command } = comparison;
  const scaled = (value, factor) => (typeof value === "number" ? value * factor : null);
  return html`
    <table class="replay-figures">
      <caption class="unseen">The run as it was and as it was seen again</caption>
      <thead><tr><th scope="col"><span class="unseen">Figure</span></th><th scope="col">Then</th><th scope="col">Now</th><th scope="col">Difference</th></tr></thead>
      <tbody>${THEN_AND_NOW.map(([title, digits, factor, unit, name]) => {
        const [then, now] = [scaled(comparison[name].then, factor), scaled(comparison[name].now, factor)];
        return html`<tr><th scope="row">${title} <span class="soft">${unit}</span></th><td>${fixed(then, digits)}</td><td>${fixed(now, digits)}</td><td>${difference(then, now, digits)}</td></tr>`;
      })}</tbody>
    </table>
    <p class="hint">The places differ by ${fixed(place.mean, 3)} mm on average and ${fixed(place.max, 2)} mm at most, the headings by ${fixed(heading.mean, 2)}° and ${fixed(heading.max, 1)}°. Dashed in the charts: as seen again.</p>
    ${command && html`<p class="hint">The controller would have taken the same pivot in ${fixed(100 * command.same_pivot_share, 1)} % of the time, with rates that differ by ${fixed(command.rate_deg_s.rms, 1)} °/s. It was not obeyed.</p>`}
  `;
}
