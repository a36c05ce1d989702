/** The list: a row a study with its progress; one opens in the list's place. */
import { exactly, when } from "../runs/words.js";
import { fixed } from "../units.js";
import { html } from "../view.js";
import { openStudy, rowId } from "./listing.js";
import { metricOf, onWords, progressWords } from "./words.js";

export const List = ({ studies }) => html`
  <ul class="study-list" aria-label="Studies, newest first" onKeyDown=${walk}>
    ${studies.map((study) => html`<${Row} key=${study.id} study=${study} />`)}
  </ul>
`;

function Row({ study }) {
  return html`
    <li class="study-row" data-study=${study.id} onClick=${() => openStudy(study.id)}>
      <button class="study-name" type="button" id=${rowId(study.id)}>${study.name || study.id}</button>
      <${State} study=${study} />
      <${Bar} study=${study} />
      <span class="study-progress">${progressWords(study)}</span>
      <span class="study-best">${study.best ? bestWords(study.best) : ""}</span>
      <span class="soft study-when"><time datetime=${study.created_at} title=${exactly(study.created_at)}>${when(study.created_at)}</time>, ${onWords(study.on)}</span>
      ${study.current && html`<span class="study-current">${study.current}</span>`}
    </li>
  `;
}

/** "best ME 0.142 at tilt 25 °, sweep 30 °" */
function bestWords({ metric, mean, words }) {
  const [, title, , digits] = metricOf(metric);
  return `best ${title} ${fixed(mean, digits)}${words ? ` at ${words}` : ""}`;
}

export const State = ({ study }) => html`<span class="study-state" data-state=${study.state}>${study.state}</span>`;

export const Bar = ({ study }) => html`
  <progress max=${Math.max(1, study.total)} value=${study.done} aria-label=${`Progress of ${study.name || study.id}`}></progress>
`;

/** Up and down between the names, as in the list of runs. */
function walk(event) {
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!step || !event.target.matches(".study-name")) return;
  const names = [...event.currentTarget.querySelectorAll(".study-name")];
  const next = names[names.indexOf(event.target) + step];
  if (!next) return;
  event.preventDefault();
  next.focus();
}
