/** What is said of the next run alone, folded: its label and tags, and whether anybody watches. */
import { set, useStore } from "../store.js";
import { html, useId, useState } from "../view.js";

const tagsOf = (text) => [...new Set(text.split(",").map((word) => word.trim()).filter(Boolean))];

export function Options() {
  const next = useStore((state) => state.nextRun);
  const walked = useStore((state) => state.walked);
  const change = (part) => set({ nextRun: { ...next, ...part } });
  const ids = { label: useId(), tags: useId(), unattended: useId() };
  return html`
    <details class="part options">
      <summary><span>${walked ? "The next run's label and tags" : "Label and tags"}</span><span class="soft">${summary(next)}</span></summary>
      <div class="fields">
        <div class="field field-wide"><label for=${ids.label}>Label</label>
          <input id=${ids.label} type="text" autocomplete="off" maxlength="200" placeholder="What the list of runs calls it" value=${next.label}
            onInput=${(event) => change({ label: event.target.value })} /></div>
        <div class="field field-wide"><label for=${ids.tags}>Tags, with commas between</label>
          <${Tags} id=${ids.tags} tags=${next.tags} take=${(tags) => change({ tags })} /></div>
        <div class="field field-wide field-line">
          <input id=${ids.unattended} type="checkbox" checked=${next.unattended} aria-describedby=${`${ids.unattended}-words`}
            onChange=${(event) => change({ unattended: event.target.checked })} onKeyDown=${(event) => event.key === "Enter" && change({ unattended: !next.unattended })} />
          <label for=${ids.unattended}>Unattended</label>
          <p class="hint" id=${`${ids.unattended}-words`}>Nobody watches: the run belongs to the server and goes on when this page is closed.</p>
        </div>
      </div>
    </details>
  `;
}

const summary = ({ label, tags, unattended }) => [label, ...tags, unattended ? "unattended" : ""].filter(Boolean).join(", ") || "none";

/** What is typed stays as it is typed, also a comma at its end, until the run has begun. */
function Tags({ id, tags, take }) {
  const [text, setText] = useState(tags.join(", "));
  const shown = tagsOf(text).join() === tags.join() ? text : tags.join(", ");
  const type = (event) => {
    setText(event.target.value);
    take(tagsOf(event.target.value));
  };
  return html`<input id=${id} type="text" autocomplete="off" placeholder="calibrated, wet plate" value=${shown} onInput=${type} />`;
}
