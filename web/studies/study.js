/** One study: how far it is, what it does now, its figures, and what can be done with it. */
import { html, useEffect, useRef, useState } from "../view.js";
import { filterBy, NO_FILTER } from "../runs/listing.js";
import { DownloadMenu } from "../runs/menu.js";
import { counted, exactly } from "../runs/words.js";
import { compose } from "./composing.js";
import { CampaignConsent, needsConsent } from "./consent.js";
import { DeleteDialog } from "./delete.js";
import { Figures } from "./figures.js";
import { Bar, State } from "./list.js";
import { closeStudy, resumeStudy, stopStudy, useStudies } from "./listing.js";
import { metricOf, onWords, progressWords, setText, withInterval } from "./words.js";
import { showTab } from "../journal/tab.js";

export function StudyPage({ id }) {
  const { study, trouble, working } = useStudies((studies) => studies);
  const title = useRef(null);
  useEffect(() => void title.current?.focus({ preventScroll: true }), []);
  return html`
    <article class="study" aria-labelledby="study-title">
      <header class="study-head">
        <button class="quiet back" type="button" onClick=${closeStudy}>‹ All studies</button>
        <h3 id="study-title" ref=${title} tabindex="-1">${study ? study.name || study.id : id}</h3>
        ${study && html`<${State} study=${study} />`}
      </header>
      ${study ? html`<${Page} study=${study} trouble=${trouble} working=${working} />` : html`<p class="hint padded" role="status">${trouble || "Loading…"}</p>`}
    </article>
  `;
}

function Page({ study, trouble, working }) {
  return html`
    <div class="study-page">
      <div class="study-standing">
        <${Bar} study=${study} />
        <p><span>${progressWords(study)}</span><span class="soft"> · ${onWords(study.on)}, begun ${exactly(study.created_at)}</span></p>
        <p class="study-now" aria-live="polite">${study.current || study.reason}</p>
        ${study.best && html`<${Best} study=${study} />`}
        ${study.answer && html`<${Answer} study=${study} />`}
      </div>
      <${Buttons} study=${study} working=${working} />
      <div class="outcome" aria-live="polite">${trouble && html`<p class="field-error">${trouble}</p>`}</div>
      <${Figures} key=${study.id} study=${study} />
    </div>
  `;
}

const soFar = (state) => (state === "finished" ? "" : " so far");

function Best({ study: { best, axes, state } }) {
  const [, words, unit, digits] = metricOf(best.metric);
  const where = axes.length > 0 ? ` at ${setText(best.values, axes)}` : "";
  return html`<p>Smallest ${words}${soFar(state)}: <b>${withInterval(best, digits)}</b> ${unit}${where} (n = ${best.runs}).</p>`;
}

/** What a search for the best has found. */
function Answer({ study: { answer, axes } }) {
  const { values, expected, measured, runs, left } = answer;
  const [, words, unit, digits] = metricOf(answer.metric);
  return html`
    <p>The search's answer: ${setText(values, axes)}, where ${words} is expected to be ${withInterval(expected, digits)} ${unit};
      ${measured ? html` measured there in ${counted(runs, "run")}: <b>${withInterval(measured, digits)}</b>` : left > 0 ? " not confirmed yet" : " no finished run confirms it"}.</p>
  `;
}

function Buttons({ study, working }) {
  const [asking, ask] = useState(false);
  const [agreeing, agree] = useState(false);
  const resume = () => (needsConsent(study.on) ? agree(true) : resumeStudy(study.id));
  const running = study.state === "running";
  const over = study.state === "finished";
  const nothing = study.done > 0 ? "" : "No run has finished yet.";
  const address = `/api/v1/studies/${encodeURIComponent(study.id)}`;
  return html`
    <div class="run-buttons">
      ${running && html`<button class="next" type="button" disabled=${working !== ""} onClick=${() => stopStudy(study.id)}>Stop study</button>`}
      ${!running && !over && html`<button class="next" type="button" disabled=${working !== ""} onClick=${resume}>${study.state === "planned" ? "Start study" : "Resume study"}</button>`}
      <${Report} href=${`${address}/report`} why=${nothing} />
      <${DownloadMenu} title="Download" why=${nothing} links=${FILES.map(([file, words]) => [`${address}/${file}`, words])} />
      ${study.on === "rig" && html`<button type="button" onClick=${() => showRunsOf(study)}>Its runs</button>`}
      <button type="button" onClick=${() => compose(study.definition)}>Use as a new study</button>
      <button type="button" disabled=${running} title=${running ? "It goes on; stop it first." : ""} onClick=${() => ask(true)}>Delete…</button>
    </div>
    ${running && study.on === "rig" && html`<p class="hint">It goes on by itself, also when this page is closed. STOP ends it; it can be resumed.</p>`}
    ${agreeing && html`<${CampaignConsent} go=${() => resumeStudy(study.id, true)} close=${() => agree(false)} />`}
    ${asking && html`<${DeleteDialog} study=${study} close=${() => ask(false)} />`}
  `;
}

/** A page of its own; before there is anything on it, a button that cannot be pressed. */
function Report({ href, why }) {
  if (why) return html`<button type="button" disabled title=${why}>Report</button>`;
  return html`<a class="button" href=${href} target="_blank" rel="noopener">Report</a>`;
}

/** [file, words] */
const FILES = [["table.csv", "Table, CSV"], ["plot.png", "Figure, PNG"], ["report.zip", "Everything, ZIP"]];

function showRunsOf(study) {
  filterBy({ ...NO_FILTER, study: study.id });
  showTab("runs");
}
