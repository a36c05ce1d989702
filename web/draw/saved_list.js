/** The saved paths: open one, give it another name, delete it and have it back. */
import { html, useState } from "../view.js";
import { deletePath, openPath, renamePath, restorePath } from "./saved.js";

export function SavedPaths({ names }) {
  const [gone, setGone] = useState(null);
  const [error, setError] = useState("");
  if (names.length === 0 && !gone) return null;
  const told = async (work) => setError(await work);
  const forget = (name) => told(deletePath(name, setGone));
  const restore = async () => {
    const refused = await restorePath(gone);
    setError(refused);
    if (!refused) setGone(null);
  };
  return html`
    <details class="more saved-paths">
      <summary>Saved paths <span class="soft">${names.length}</span></summary>
      ${names.length > 0 && html`
        <ul>
          ${names.map((name) => html`<${SavedPath} key=${name} name=${name} open=${() => told(openPath(name))} rename=${(next) => told(renamePath(name, next))} forget=${() => forget(name)} />`)}
        </ul>`}
      ${gone && html`<p class="row" role="status">“${gone.name}” is deleted. <button class="quiet" type="button" onClick=${restore}>Undo delete</button></p>`}
      ${error && html`<p class="field-error" role="alert">${error}</p>`}
    </details>
  `;
}

function SavedPath({ name, open, rename, forget }) {
  const [next, setNext] = useState(null);
  const take = async (event) => {
    event.preventDefault();
    if (next.trim() !== name) await rename(next.trim());
    setNext(null);
  };
  if (next !== null) {
    return html`
      <li>
        <form class="name-form" onSubmit=${take}>
          <input type="text" aria-label=${`New name of ${name}`} maxlength="60" required autocomplete="off" value=${next} onInput=${(event) => setNext(event.target.value)} />
          <button type="submit">Rename</button>
          <button class="quiet" type="button" onClick=${() => setNext(null)}>Cancel</button>
        </form>
      </li>
    `;
  }
  return html`
    <li>
      <span class="name">${name}</span>
      <button class="quiet" type="button" aria-label=${`Edit ${name}`} onClick=${open}>Edit</button>
      <button class="quiet" type="button" aria-label=${`Rename ${name}`} onClick=${() => setNext(name)}>Rename</button>
      <button class="quiet" type="button" aria-label=${`Delete ${name}`} onClick=${forget}>Delete</button>
    </li>
  `;
}
