/** Controller, trajectory, gait and passes of the next run. */
import { applyToRun, select, showSelectedPath } from "../live/actions.js";
import { set, useStore } from "../store.js";
import { html, useEffect } from "../view.js";
import { Field, SchemaForm } from "./form.js";
import { PathPicture } from "./preview.js";
import { defaultsOf } from "./schema.js";

const PASSES = {
  name: "passes", title: "Passes", description: "How often the path is walked.", unit: "", kind: "number",
  integer: false, optional: false, initial: 1, above: 0, high: 1000,
};

const wide = matchMedia("(min-width: 700px)").matches;

export function Settings() {
  const selection = useStore((state) => state.selection);
  const catalogue = useStore(({ controllers, trajectories }) => ({ controllers, trajectories }));
  const gaitSchema = useStore((state) => state.gaitSchema);
  const running = useStore((state) => Boolean(state.tick?.run));
  useEffect(() => void showSelectedPath(selection.trajectory), [selection.trajectory]);
  return html`
    <div class="settings">
      ${running && html`
        <div class="apply">
          <p class="hint">Changes below are for the next run.</p>
          <button type="button" onClick=${applyToRun}>Apply to this run</button>
        </div>`}
      <${Part} part="controller" title="Controller" entries=${catalogue.controllers} chosen=${selection.controller} />
      <${Part} part="trajectory" title="Trajectory" entries=${catalogue.trajectories} chosen=${selection.trajectory}>
        <${PathPicture} />
      <//>
      <${Gait} schema=${gaitSchema} gait=${selection.gait} />
    </div>
  `;
}

/** A choice from the catalogue with the form of what was chosen. */
function Part({ part, title, entries, chosen, children }) {
  const error = useStore((state) => state.serverErrors[part] ?? "");
  const entry = entries.find(({ name }) => name === chosen.name);
  const choose = (event) => {
    const next = entries[event.target.selectedIndex];
    select({ [part]: { name: next.name, parameters: defaultsOf(next.parameters) } });
  };
  const change = (name, value) => select({ [part]: { ...chosen, parameters: { ...chosen.parameters, [name]: value } } });
  return html`
    <details class="part" open=${wide}>
      <summary><span>${title}</span><span class="soft">${entry?.title ?? chosen.name}</span></summary>
      <label class="unseen" for=${`choose-${part}`}>${title}</label>
      <div class="choose">
        <select id=${`choose-${part}`} onChange=${choose}>
          ${entries.map(({ name, title: shown }) => html`<option value=${name} selected=${name === chosen.name}>${shown}</option>`)}
        </select>
        <${Defaults} of=${title} schema=${entry?.parameters} apply=${(parameters) => select({ [part]: { ...chosen, parameters } })} />
      </div>
      ${entry?.summary && html`<p class="hint">${entry.summary}</p>`}
      <p class="field-error" aria-live="polite">${error}</p>
      ${children}
      <${SchemaForm} section=${part} schema=${entry?.parameters} values=${chosen.parameters} onChange=${change} />
    </details>
  `;
}

function Gait({ schema, gait }) {
  const passes = useStore((state) => state.passes);
  return html`
    <details class="part" open=${wide}>
      <summary><span>Gait</span><span class="soft">${gait.sweep_deg}° sweep, ${gait.tilt_deg}° tilt</span></summary>
      <${SchemaForm} section="gait" schema=${schema} values=${gait} onChange=${(name, value) => select({ gait: { ...gait, [name]: value } })}>
        <${Field} id="passes" form=${PASSES} value=${passes} onChange=${(value) => set({ passes: value })} />
      <//>
      <${Defaults} of="Gait" schema=${schema} apply=${(values) => select({ gait: { ...gait, ...values } })} />
    </details>
  `;
}

function Defaults({ of, schema, apply }) {
  const defaults = defaultsOf(schema);
  if (Object.keys(defaults).length === 0) return null;
  return html`<button class="quiet defaults" type="button" aria-label=${`${of}: back to defaults`} onClick=${() => apply(defaults)}>Defaults</button>`;
}
