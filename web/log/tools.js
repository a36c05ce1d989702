/** What of the log is shown, and how to take it along. */
import { download } from "../download.js";
import { get, say, useStore } from "../store.js";
import { html, useState } from "../view.js";
import { loadAll, search, show, useLog } from "./listing.js";
import { asText, CHOICES, matching } from "./words.js";

const COPIED_MS = 2000;

/** @param {{found: import("./words.js").LogEvent[]}} props */
export function Tools({ found }) {
  const { severity, text } = useLog((log) => log);
  return html`
    <div class="log-tools">
      <fieldset class="segments">
        <legend class="unseen">Severity</legend>
        ${CHOICES.map(([name, words]) => html`
          <label key=${name}><input type="radio" name="log-severity" checked=${severity === name} onChange=${() => show(name)} /><span>${words}</span></label>
        `)}
      </fieldset>
      <input type="search" aria-label="Find in the log" placeholder="Find in the log" value=${text} onInput=${(event) => search(event.target.value)} />
      <span class="soft log-count">${found.length} ${found.length === 1 ? "line" : "lines"}</span>
      <${Copy} /><${Download} />
    </div>
  `;
}

/** The whole session as far as the filter goes, also what has not been scrolled to yet. */
async function wholeText() {
  await loadAll();
  const { events, log } = get();
  return `${asText(matching(events, log))}\n`;
}

function Copy() {
  const [done, setDone] = useState(false);
  // A page that came over plain HTTP from elsewhere may not write to the clipboard: it downloads.
  if (!navigator.clipboard) return null;
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(await wholeText());
      setDone(true);
      setTimeout(() => setDone(false), COPIED_MS);
    } catch (problem) {
      say(`The log could not be copied (${problem instanceof Error ? problem.message : "the browser refuses"}); download it instead.`);
    }
  };
  return html`<button type="button" onClick=${copy}>${done ? "Copied" : "Copy"}</button>`;
}

function Download() {
  const rig = useStore((state) => state.rig?.name ?? "rig");
  const save = async () => {
    download(`${rig.replace(/[^\w-]+/g, "-")}-log.txt`, await wholeText(), "text/plain");
  };
  return html`<button type="button" onClick=${save}>Download</button>`;
}
