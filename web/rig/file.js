/** The rig file itself: where it is, to take along, and another one to take over. */
import { useStore } from "../store.js";
import { html, useRef } from "../view.js";
import { NotAtRest } from "./changes.js";
import { inWords, titleAt } from "./fields.js";
import { apply, choose, putAway, undo, useRigPage } from "./settings.js";

export function RigFile({ sections }) {
  const file = useStore((state) => state.rig?.file);
  const chosen = useRigPage((page) => page.file);
  if (!file) return html`<p class="hint padded">This server has no rig file: what is changed here is not kept.</p>`;
  return html`
    <header class="rig-head"><h2>Rig file</h2><p class="hint">Every value of this rig is in one file, which you can read, copy and edit.</p></header>
    <dl class="facts">
      <div><dt>Path</dt><dd><code>${file.path}</code></dd></div>
      <div><dt>State</dt><dd>${file.saved ? "saved" : "nothing has been saved yet: the values are the program’s own"}${file.changed_on_disk ? ", and changed on the disk since" : ""}</dd></div>
    </dl>
    <div class="row">
      <a class="download" href="/api/v1/rig/file.toml" download="rig.toml">Export the rig file</a>
      <${Choose} />
      <${Undo} file=${file} />
    </div>
    <p class="hint">The exported file has your comments. Logins of cameras and the key of a webhook are left out of it.</p>
    ${chosen && html`<${Chosen} chosen=${chosen} sections=${sections} />`}
  `;
}

function Choose() {
  const input = useRef(null);
  const take = (event) => {
    const [file] = event.target.files;
    if (file) choose(file);
    // The same file can be chosen again after it has been mended.
    event.target.value = "";
  };
  return html`
    <button type="button" onClick=${() => input.current.click()}>Import a rig file…</button>
    <input class="unseen" type="file" tabindex="-1" accept=".toml,text/plain" aria-label="Rig file to import" ref=${input} onChange=${take} />
  `;
}

function Undo({ file }) {
  const disarmed = useStore(({ tick }) => tick?.rig === "disarmed");
  const working = useRigPage((page) => page.working !== "");
  if (!file.previous) return null;
  return html`<button type="button" disabled=${!disarmed || working} title=${disarmed ? "Back to the file as it was before its last change; once more goes forth again" : "The rig must be disarmed for it"} onClick=${undo}>Undo the last change</button>`;
}

function Chosen({ chosen, sections }) {
  const state = useStore(({ tick }) => tick?.rig ?? "");
  const working = useRigPage((page) => page.working !== "");
  const { name, differences, error } = chosen;
  return html`
    <section class="rig-import" aria-label=${`Import of ${name}`}>
      <h3>${name}</h3>
      ${error && html`<pre class="field-error" role="alert">${error}</pre>`}
      ${!error && differences === null && html`<p class="hint">Looking at it…</p>`}
      ${differences?.length === 0 && html`<p>No value in it differs from this rig’s; applying it takes over its comments and layout.</p>`}
      ${differences?.length > 0 && html`<${Differences} differences=${differences} sections=${sections} />`}
      ${differences && state !== "disarmed" && html`<${NotAtRest} state=${state} />`}
      <div class="row">
        ${differences && html`<button class="next" type="button" disabled=${working || state !== "disarmed"} onClick=${apply}>Apply the file</button>`}
        <button type="button" onClick=${putAway}>${error ? "Close" : "Cancel"}</button>
      </div>
    </section>
  `;
}

function Differences({ differences, sections }) {
  return html`
    <p>It would change ${differences.length === 1 ? "one value" : `${differences.length} values`}:</p>
    <ul class="rig-differences" aria-label="Differences">
      ${differences.map(({ field, from, to }) => {
        const { title, unit } = titleAt(sections, field);
        return html`<li key=${field}><span>${title}</span><span><s class="soft">${inWords(from, unit)}</s> → <strong>${inWords(to, unit)}</strong></span></li>`;
      })}
    </ul>
  `;
}
