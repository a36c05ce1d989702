/** A new study: what varies, how often, on what; beside it how many runs that are and how long they take. */
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { counted } from "../runs/words.js";
import { axisGroups } from "./axis_choices.js";
import { AxisRows } from "./axis_rows.js";
import { closeForm, saveFile, setField, setFields, start, takeFile, takeSelection, useDraft } from "./composing.js";
import { CampaignConsent, needsConsent } from "./consent.js";
import { DESIGNS } from "./draft.js";
import { Choice, Entry, Select } from "./entry.js";
import { Limits } from "./limits.js";
import { roughly } from "./words.js";

const ON = [["batch", "Fast simulation"], ["rig", "This rig, run by run"]];
const ORDER = [["blocked", "Shuffled in blocks"], ["random", "All shuffled"], ["listed", "As listed"]];

export function Form() {
  const title = useRef(null);
  const version = useDraft((draft) => draft.version);
  const on = useDraft(({ rest }) => rest.on);
  const [agreeing, agree] = useState(false);
  useEffect(() => void title.current?.focus({ preventScroll: true }), []);
  const submit = (event) => {
    event.preventDefault();
    if (needsConsent(on)) agree(true);
    else start();
  };
  return html`
    <article class="study" aria-labelledby="new-study-title">
      <header class="study-head">
        <button class="quiet back" type="button" onClick=${closeForm}>‹ All studies</button>
        <h3 id="new-study-title" ref=${title} tabindex="-1">New study</h3>
        <${Files} />
      </header>
      <form class="study-form" key=${version} onSubmit=${submit}>
        <div class="study-fields"><${Fields} /></div>
        <${Preview} />
      </form>
      ${agreeing && html`<${CampaignConsent} go=${() => start(true)} close=${() => agree(false)} />`}
    </article>
  `;
}

function Files() {
  const toml = useDraft(({ preview }) => Boolean(preview?.toml));
  const chosen = useRef(null);
  const take = (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (file) takeFile(file);
  };
  return html`
    <span class="study-files">
      <input class="unseen" type="file" accept=".toml" tabindex="-1" aria-label="Study definition" ref=${chosen} onChange=${take} />
      <button class="quiet" type="button" onClick=${() => chosen.current.click()}>Import TOML…</button>
      <button class="quiet" type="button" disabled=${!toml} onClick=${saveFile}>Export TOML</button>
    </span>
  `;
}

function Fields() {
  const rest = useDraft((draft) => draft.rest);
  const known = useStore(({ controllers, trajectories, plants, gaitSchema }) => ({ controllers, trajectories, plants, gaitSchema }));
  return html`
    <div class="fields">
      <${Entry} path=${["name"]} title="Name" kind="text" placeholder="Tilt and path step" />
      <${Select} title="On" options=${ON} value=${rest.on} choose=${turnTo(rest)} />
      <${Choice} path=${["design"]} title="Design" options=${DESIGNS} />
      <${Entry} path=${["repeats"]} title="Runs of each set" />
    </div>
    <${AxisRows} groups=${axisGroups(known, rest)} />
    <${Fixed} rest=${rest} known=${known} />
    <${Limits} rest=${rest} order=${ORDER} />
  `;
}

/** A rig has a plant of its own and starts where the robot is; a batch has nothing to wait for. */
const turnTo = (rest) => (on) =>
  setFields(on === "rig" ? { on, plant: undefined, start: undefined } : { on, rig: undefined, plant: rest.plant ?? { name: "slip" } });

/** What every run has in common, in a line, with a way to take over what the page has selected. */
function Fixed({ rest, known }) {
  const titleOf = (entries, part) => (entries ?? []).find(({ name }) => name === part?.name)?.title ?? part?.name ?? "–";
  const gait = rest.gait ?? {};
  const words = [
    titleOf(known.controllers, rest.controller), `on ${titleOf(known.trajectories, rest.trajectory).toLowerCase()}`,
    gait.sweep_deg && `${gait.sweep_deg}° sweep`, gait.tilt_deg && `${gait.tilt_deg}° tilt`, gait.path_step_s && `${gait.path_step_s} s path step`,
  ];
  return html`
    <fieldset class="fixed">
      <legend>The same in every run, unless it varies</legend>
      <p>${words.filter(Boolean).join(", ")}.</p>
      <p class="hint">Choose controller, trajectory and gait in the run panel above. <button class="quiet" type="button" onClick=${takeSelection}>Take the page's selection</button></p>
      ${rest.on !== "rig" && html`<div class="fields"><${Select} title="Plant" options=${(known.plants ?? []).map(({ name, title }) => [name, title])} value=${rest.plant?.name ?? "slip"} choose=${(name) => setField(["plant"], { name })} /></div>`}
    </fieldset>
  `;
}

function Preview() {
  const { preview, problems, error, asking, starting, rest } = useDraft((draft) => draft);
  const wrong = Object.entries(problems);
  const ready = preview !== null && wrong.length === 0 && !error;
  return html`
    <aside class="study-preview" aria-label="Before it starts">
      <p class="study-size" aria-live="polite">${preview?.runs ? html`<b>${counted(preview.runs, "run")}</b><span>${sizeWords(preview, rest)}</span>` : html`<b>–</b><span>${asking ? "counting…" : "not complete yet"}</span>`}</p>
      ${wrong.length > 0 && html`<ul class="study-problems">${wrong.map(([field, text]) => html`<li key=${field} class="field-error">${field && html`<span class="soft">${field}: </span>`}${text}</li>`)}</ul>`}
      <div class="outcome" aria-live="polite">${error && html`<p class="field-error">${error}</p>`}</div>
      <button class="primary" type="submit" disabled=${!ready || starting}>${starting ? "Starting…" : "Start study"}</button>
      <button type="button" onClick=${closeForm}>Cancel</button>
    </aside>
  `;
}

function sizeWords({ sets, seconds, rig_seconds }, { on, repeats }) {
  const parts = [sets === null || sets === undefined ? "" : `${counted(sets, "set")} × ${repeats ?? 1}`];
  parts.push(on === "rig" ? `about ${roughly(seconds)} on the rig, with the ways back` : `about ${roughly(seconds)} on this computer for ${roughly(rig_seconds)} of walking`);
  return parts.filter(Boolean).join(" · ");
}
