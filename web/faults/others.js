/** All faults of the catalogue, by what they befall; each with its values, for how long, and whether it comes and goes. */
import { Field, SchemaForm } from "../forms/form.js";
import { useStore } from "../store.js";
import { html, useState } from "../view.js";
import { putIn, usualOf } from "./catalogue.js";
import { FAMILIES, grouped, promiseWords } from "./words.js";

export function Others({ faults }) {
  const [search, setSearch] = useState("");
  const groups = grouped(faults, search);
  return html`
    <section class="all-faults" aria-labelledby="all-faults-title">
      <header><h3 id="all-faults-title">All ${faults.length} faults</h3>
        <label class="unseen" for="search-faults">Search the faults</label>
        <input id="search-faults" type="search" placeholder="Search: light, supply, NaN…" value=${search} onInput=${(event) => setSearch(event.target.value)} /></header>
      ${groups.length === 0 && html`<p class="hint">No fault has these words.</p>`}
      ${groups.map(([family, list]) => html`
        <section key=${family} aria-label=${FAMILIES[family] ?? family}>
          <h4>${FAMILIES[family] ?? family}</h4>
          ${list.map((fault) => html`<${Other} key=${fault.name} fault=${fault} />`)}
        </section>`)}
    </section>
  `;
}

function Other({ fault }) {
  const [open, setOpen] = useState(false);
  return html`
    <details class="fault" open=${open} onToggle=${(event) => setOpen(event.currentTarget.open)}>
      <summary><span>${fault.title}${fault.injected && html` <span class="badge">IN</span>`}</span><span class="soft">${fault.what}</span></summary>
      ${open && html`<${Values} fault=${fault} />`}
    </details>
  `;
}

const SECONDS = { description: "", unit: "s", kind: "number", integer: false, optional: true, initial: null, choices: [], low: 0.01, high: 86400 };
const DURATION = { ...SECONDS, name: "duration_s", title: "For", description: "Left empty: until it is taken away." };
const ON = { ...SECONDS, name: "on_s", title: "Comes for", description: "Both left empty: it stays." };
const OFF = { ...SECONDS, name: "off_s", title: "Goes for" };

function Values({ fault }) {
  const section = `fault ${fault.name}`;
  const [parameters, setParameters] = useState(() => usualOf(fault));
  const [times, setTimes] = useState(/** @type {Record<string, number | null>} */ ({ duration_s: null, on_s: null, off_s: null }));
  const [refusal, setRefusal] = useState("");
  const isWrong = useStore((state) => Object.keys(state.draftErrors).some((key) => key.startsWith(section)));
  const half = (times.on_s === null) !== (times.off_s === null);
  const put = async () => {
    const { duration_s, on_s, off_s } = times;
    const problem = await putIn(fault.name, { parameters, duration_s, intermittent: on_s === null || off_s === null ? null : { on_s, off_s } });
    setRefusal(problem?.message ?? "");
  };
  const time = (form) => html`<${Field} id=${`${section}.${form.name}`} form=${form} value=${times[form.name]} onChange=${(value) => setTimes({ ...times, [form.name]: value })} />`;
  return html`
    <div class="fault-values">
      <p class="hint">${promiseWords(fault.promise)} It mends ${fault.mends}.</p>
      <${SchemaForm} section=${section} schema=${fault.parameters} values=${parameters} onChange=${(name, value) => setParameters({ ...parameters, [name]: value })}>
        ${!fault.happens_once && [DURATION, ON, OFF].map(time)}
      <//>
      ${half && html`<p class="hint">A fault that comes and goes needs both times.</p>`}
      <p class="field-error" role="alert">${refusal}</p>
      <button type="button" aria-label=${`Put in: ${fault.title}`} disabled=${isWrong || half} onClick=${put}>${fault.injected ? "Put in anew" : "Put in"}</button>
    </div>
  `;
}
