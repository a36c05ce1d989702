/** What is searched for: words, and what a run has to be; with the number found. */
import { useStore } from "../store.js";
import { html, useState } from "../view.js";
import { filterBy, isFiltered, NO_FILTER, useListing } from "./listing.js";

const STATES = ["running", "finished", "stopped", "aborted", "interrupted"].map((state) => [state, state]);
const PINNED = [["true", "pinned"], ["false", "not pinned"]];
const SIMULATED = [["false", "real rig"], ["true", "simulated"]];

const titles = (entries) => entries.map(({ name, title }) => [name, title ?? name]);

export function Filters() {
  const filter = useListing((listing) => listing.filter);
  const [shown, show] = useState(false);
  const controllers = useStore((state) => state.controllers);
  const trajectories = useStore((state) => state.trajectories);
  const active = Object.entries(filter).filter(([name, value]) => name !== "text" && value).length;
  return html`
    <form class="filters" role="search" aria-label="Runs" data-shown=${shown} onSubmit=${(event) => event.preventDefault()}>
      <span class="search">
        <input type="text" inputmode="search" aria-label="Search runs by name, notes and tags" placeholder="Search runs" value=${filter.text}
          maxlength="200" onInput=${(event) => filterBy({ text: event.target.value })} />
        <${Found} filtered=${isFiltered(filter)} />
      </span>
      <button class="quiet more-filters" type="button" aria-expanded=${shown} onClick=${() => show(!shown)}>Filters${active > 0 ? ` (${active})` : ""}</button>
      <div class="choices-of-runs">
        <${Choice} name="state" title="State" choices=${STATES} chosen=${filter.state} />
        <${Choice} name="controller" title="Controller" choices=${titles(controllers)} chosen=${filter.controller} />
        <${Choice} name="trajectory" title="Trajectory" choices=${titles(trajectories)} chosen=${filter.trajectory} />
        <input type="text" aria-label="Tag" placeholder="Tag" value=${filter.tag} list="known-tags" maxlength="40" data-set=${Boolean(filter.tag)}
          onInput=${(event) => filterBy({ tag: event.target.value.trim() })} />
        <${KnownTags} />
        <${Choice} name="pinned" title="Pinned" choices=${PINNED} chosen=${filter.pinned} />
        <${Choice} name="simulated" title="Rig" choices=${SIMULATED} chosen=${filter.simulated} />
        ${filter.study && html`<${OfStudy} id=${filter.study} />`}
      </div>
    </form>
  `;
}

function Choice({ name, title, choices, chosen }) {
  return html`
    <select aria-label=${title} data-set=${Boolean(chosen)} onChange=${(event) => filterBy({ [name]: event.target.value })}>
      <option value="" selected=${chosen === ""}>${title}: any</option>
      ${choices.map(([value, words]) => html`<option value=${value} selected=${value === chosen}>${words}</option>`)}
    </select>
  `;
}

/** Chosen from the study itself; here it can be let go. */
function OfStudy({ id }) {
  const name = useStore((state) => state.studies?.studies?.find((study) => study.id === id)?.name ?? id);
  return html`<button type="button" data-set="true" title="Show the runs of all studies" onClick=${() => filterBy({ study: "" })}>Study: ${name} ×</button>`;
}

/** The tags of the runs that have come so far. */
function KnownTags() {
  const runs = useListing((listing) => listing.runs);
  const tags = [...new Set((runs ?? []).flatMap((run) => run.tags ?? []))].sort();
  return html`<datalist id="known-tags">${tags.map((tag) => html`<option value=${tag} />`)}</datalist>`;
}

/** At the end of the search field, so that nothing moves when it comes. */
function Found({ filtered }) {
  const total = useListing((listing) => listing.total);
  return html`
    <span class="found" aria-live="polite">${filtered && total !== null ? `${total.toLocaleString("en")} found` : ""}</span>
    ${filtered && html`<button class="quiet" type="button" aria-label="Show all runs" title="Show all runs" onClick=${() => filterBy(NO_FILTER)}>×</button>`}
  `;
}
