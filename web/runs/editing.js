/** What people write about a run: label, tags and notes. */
import { html, useId, useState } from "../view.js";
import { useSaved } from "./saving.js";

export function Editing({ run }) {
  return html`
    <section class="run-editing" aria-label="Label, tags and notes">
      <${Text} id=${run.id} name="label" title="Label" value=${run.label ?? ""} limit=${200} />
      <${Tags} id=${run.id} tags=${run.tags ?? []} />
      <${Text} id=${run.id} name="notes" title="Notes" value=${run.notes ?? ""} limit=${20000} long />
    </section>
  `;
}

function Text({ id, name, title, value, limit, long = false }) {
  const saved = useSaved(id, name, value);
  const own = useId();
  const props = {
    id: own, maxlength: limit, value: saved.value, onBlur: saved.flush, "aria-describedby": `${own}-standing`,
    onInput: (event) => saved.type(event.target.value),
  };
  return html`
    <div class="field">
      <${Head} own=${own} title=${title} saved=${saved} />
      ${long ? html`<textarea rows="3" ...${props}></textarea>` : html`<input type="text" autocomplete="off" ...${props} />`}
    </div>
  `;
}

/** The title with the saving state at its right, so that nothing moves when the state changes. */
function Head({ own, title, saved }) {
  const { word, error } = saved.standing;
  const words = { saving: "Saving…", saved: "Saved", undone: "As before" }[word];
  return html`
    <div class="field-head">
      <label for=${own}>${title}</label>
      <span class="saving" id=${`${own}-standing`} aria-live="polite">${words}</span>
      ${saved.undo && html`<button class="quiet" type="button" onClick=${saved.undo}>Undo</button>`}
    </div>
    ${word === "refused" && html`<p class="field-error" role="alert">${error}</p>`}
  `;
}

function Tags({ id, tags }) {
  const saved = useSaved(id, "tags", tags);
  const [typed, setTyped] = useState("");
  const own = useId();
  const add = () => {
    const words = typed.split(",").map((word) => word.trim()).filter(Boolean);
    setTyped("");
    if (words.length > 0) saved.take((before) => [...new Set([...before, ...words])]);
  };
  const press = (event) => {
    if (event.key !== "Enter" && event.key !== ",") return;
    event.preventDefault();
    add();
  };
  return html`
    <div class="field">
      <${Head} own=${own} title="Tags" saved=${saved} />
      <div class="tag-box">
        ${saved.value.map((tag) => html`
          <span class="tag" key=${tag}>${tag}<button type="button" aria-label=${`Remove the tag ${tag}`} onClick=${() => saved.take((before) => before.filter((other) => other !== tag))}>×</button></span>
        `)}
        <input id=${own} type="text" autocomplete="off" placeholder="Add a tag" maxlength="40" list="known-tags" value=${typed}
          onInput=${(event) => setTyped(event.target.value)} onKeyDown=${press} onBlur=${add} aria-describedby=${`${own}-standing`} />
      </div>
    </div>
  `;
}
