/** The tab of the rig: what it is, and every value of its file. */
import { useStore } from "../store.js";
import { html, useEffect, useMemo } from "../view.js";
import { About } from "./about.js";
import { ChangeBar } from "./changes.js";
import { Connections } from "./connections.js";
import { matching, sectionsOf } from "./fields.js";
import { RigFile } from "./file.js";
import { Group, Overridden } from "./form.js";
import { Device } from "../notify/panel.js";
import { openRigPage, search, showSection, useRigPage } from "./settings.js";
import { Webhook } from "./webhook.js";

/** What stands before the sections of the file, and within one of them. */
const PAGES = { about: ["About", About], file: ["Rig file", RigFile], connections: ["Connections", Connections] };
const BESIDE = { notifications: [Webhook, Device] };

export function Rig() {
  const schema = useRigPage((page) => page.schema);
  const open = useRigPage((page) => page.section);
  const text = useRigPage((page) => page.search);
  const rig = useStore((state) => state.rig);
  const simulated = useStore((state) => Boolean(state.rig?.simulated));
  useEffect(openRigPage, [rig]);
  const sections = useMemo(() => sectionsOf(schema).filter(({ name }) => simulated || name !== "simulation"), [schema, simulated]);
  if (!rig) return html`<p class="hint padded">Loading the rig’s settings…</p>`;
  const found = text.trim() ? matching(sections, text) : null;
  return html`
    <section class="rig-page" aria-label="Rig">
      <${Index} sections=${sections} open=${found ? "" : open} text=${text} />
      <div class="rig-content" tabindex="0" role="group" aria-label="Settings">
        ${found ? html`<${Found} sections=${found} text=${text} />` : html`<${Page} name=${open} sections=${sections} />`}
      </div>
      <${ChangeBar} sections=${sections} />
    </section>
  `;
}

function Index({ sections, open, text }) {
  const entries = [...Object.entries(PAGES).map(([name, [title]]) => ({ name, title })), ...sections];
  return html`
    <nav class="rig-index" aria-label="Settings">
      <input type="search" aria-label="Find a setting" placeholder="Find a setting" value=${text} onInput=${(event) => search(event.target.value)} />
      <ul>
        ${entries.map(({ name, title }) => html`
          <li key=${name}><button type="button" aria-current=${name === open ? "true" : undefined} onClick=${() => showSection(name)}>${title}<${Mark} name=${name} /></button></li>`)}
      </ul>
    </nav>
  `;
}

/** Something in this section is changed and not saved. */
function Mark({ name }) {
  const changed = useRigPage((page) => Object.keys(page.draft).some((path) => path.startsWith(`${name}.`)));
  return changed && html`<span class="changed-mark"><span class="unseen">, changed</span></span>`;
}

function Page({ name, sections }) {
  if (name in PAGES) {
    const [, Part] = PAGES[name];
    return html`<${Part} sections=${sections} />`;
  }
  const section = sections.find((known) => known.name === name);
  if (!section) return html`<p class="hint padded">Loading the settings…</p>`;
  return html`
    <header class="rig-head"><h2>${section.title}</h2>${section.description && html`<p class="hint">${section.description}</p>`}</header>
    <${Overridden} section=${name} sections=${sections} />
    ${section.groups.map((group) => html`<${Group} key=${group.path} group=${group} />`)}
    ${(BESIDE[name] ?? []).map((Part) => html`<${Part} />`)}
  `;
}

function Found({ sections, text }) {
  if (sections.length === 0) return html`<p class="hint padded">No setting has to do with “${text}”.</p>`;
  return sections.map((section) => html`
    <header class="rig-head" key=${section.name}><h2>${section.title}</h2></header>
    ${section.groups.map((group) => html`<${Group} key=${group.path} group=${group} />`)}
  `);
}
