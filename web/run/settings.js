/** Controller, trajectory, gait and passes of the next run; what may change while the robot walks does so at once. */
import { forgetDrafts } from "../forms/draft.js";
import { Field, SchemaForm } from "../forms/form.js";
import { defaultsOf } from "../forms/schema.js";
import { applyToRun, showSelectedPath } from "../live/actions.js";
import { select } from "../live/selection.js";
import { obstacleOf } from "../operator/lease.js";
import { set, useStore } from "../store.js";
import { isOccupied } from "../studies/listing.js";
import { html, useEffect } from "../view.js";
import { edit } from "./live_values.js";
import { Options } from "./options.js";
import { PathPicture } from "./preview.js";
import { somethingWaits, standingOf } from "./standing.js";

const PASSES = {
  name: "passes", title: "Passes", description: "How often the path is walked.", unit: "", kind: "number",
  integer: false, optional: false, initial: 1, above: 0, high: 1000, step: 1,
};

const wide = matchMedia("(min-width: 700px)").matches;

export function Settings() {
  const selection = /** @type {import("../types").Selection} */ (useStore((state) => state.selection));
  const catalogue = useStore(({ controllers, trajectories }) => ({ controllers, trajectories }));
  const gaitSchema = useStore((state) => state.gaitSchema);
  const walk = useStore((state) => ({ walked: state.walked, applying: state.applying, occupied: isOccupied(state) }));
  const obstacle = useStore(obstacleOf);
  useEffect(() => void showSelectedPath(selection.trajectory), [selection.trajectory]);
  const standing = (part) => (form) => standingOf({ selection, ...walk }, part, form);
  return html`
    <div class="settings" title=${obstacle}>
      ${walk.walked && html`<${WhileItWalks} selection=${selection} ...${walk} />`}
      <${Part} part="controller" title="Controller" entries=${catalogue.controllers} chosen=${selection.controller} walked=${walk.walked} standingOf=${standing("controller")} />
      <${Part} part="trajectory" title="Trajectory" entries=${catalogue.trajectories} chosen=${selection.trajectory} walked=${walk.walked} standingOf=${standing("trajectory")}>
        <${PathPicture} />
      <//>
      <${Gait} schema=${gaitSchema} gait=${selection.gait} standingOf=${standing("gait")} walked=${walk.walked} />
      <${Options} />
    </div>
  `;
}

/** Somebody else chooses just now. */
const useLocked = () => useStore((state) => obstacleOf(state) !== "");

/** What a change means now; what waits can be taken over by a click. */
function WhileItWalks({ selection, walked, occupied }) {
  const locked = useLocked();
  if (occupied) return html`<div class="apply"><p class="hint">A study has the rig. Changes below are for the next run.</p></div>`;
  const waits = somethingWaits(selection, walked);
  return html`
    <div class="apply">
      <p class="hint">${waits ? "What is marked waits for the next run." : "Gait and gains apply at once, the rest with the next run."}</p>
      ${waits && html`<button type="button" disabled=${locked} onClick=${applyToRun}>Apply to this run</button>`}
    </div>
  `;
}

/** A choice from the catalogue with the form of what was chosen. */
function Part({ part, title, entries, chosen, walked, standingOf, children = null }) {
  const error = useStore((state) => state.serverErrors[part] ?? "");
  const entry = entries.find(({ name }) => name === chosen.name);
  const locked = useLocked();
  const choose = (event) => {
    const next = entries[event.target.selectedIndex];
    select({ [part]: { name: next.name, parameters: defaultsOf(next.parameters) } });
  };
  return html`
    <details class="part" open=${wide}>
      <summary><span>${title}</span><span class="soft">${entry?.title ?? chosen.name}</span></summary>
      <label class="unseen" for=${`choose-${part}`}>${title}</label>
      <div class="choose">
        <select id=${`choose-${part}`} disabled=${locked} onChange=${choose}>
          ${entries.map(({ name, title: shown }) => html`<option value=${name} selected=${name === chosen.name}>${shown}</option>`)}
        </select>
        <${Defaults} of=${title} section=${part} schema=${entry?.parameters} apply=${(parameters) => select({ [part]: { ...chosen, parameters } })} />
      </div>
      ${walked && walked[part].name !== chosen.name && html`<p class="field-standing" data-state="waits">for the next run; this one walks by ${titleOf(entries, walked[part].name)}</p>`}
      ${entry?.summary && html`<p class="hint">${entry.summary}</p>`}
      <p class="field-error" aria-live="polite">${error}</p>
      ${children}
      <${SchemaForm} section=${part} of=${`${part}.${chosen.name}`} schema=${entry?.parameters} values=${chosen.parameters} locked=${locked} standingOf=${standingOf}
        onChange=${(name, value) => edit(part, formOf(entry.parameters, name), value)} />
    </details>
  `;
}

const titleOf = (entries, name) => entries.find((entry) => entry.name === name)?.title ?? name;

/** As much of a field as an edit needs. */
const formOf = (schema, name) => /** @type {any} */ ({ name, live: schema?.properties?.[name]?.live ?? false });

function Gait({ schema, gait, standingOf, walked }) {
  const passes = useStore((state) => state.passes);
  const locked = useLocked();
  const standing = !walked ? null : { state: walked.passes === passes ? "quiet" : "waits", words: "for the next run" };
  return html`
    <details class="part" open=${wide}>
      <summary><span>Gait</span><span class="soft">${gait.sweep_deg}° sweep, ${gait.tilt_deg}° tilt</span></summary>
      <${SchemaForm} section="gait" schema=${schema} values=${gait} locked=${locked} standingOf=${standingOf} onChange=${(name, value) => edit("gait", formOf(schema, name), value)}>
        <${Field} id="passes" of="run" form=${PASSES} value=${passes} locked=${locked} standing=${standing} onChange=${(value) => set({ passes: value })} />
      <//>
      <${Defaults} of="Gait" section="gait" schema=${schema} apply=${(values) => select({ gait: { ...gait, ...values } })} />
    </details>
  `;
}

function Defaults({ of, section, schema, apply }) {
  const locked = useLocked();
  const defaults = defaultsOf(schema);
  if (Object.keys(defaults).length === 0) return null;
  const press = () => {
    forgetDrafts(section);
    apply(defaults);
  };
  return html`<button class="quiet defaults" type="button" disabled=${locked} aria-label=${`${of}: back to defaults`} onClick=${press}>Defaults</button>`;
}
