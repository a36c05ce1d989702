/** What belongs to drawing a path: how it is drawn, what was done, how long it is, and what becomes of it. */
import { passTime } from "../run/preview.js";
import { useStore } from "../store.js";
import { clock, quantity } from "../units.js";
import { html, useState } from "../view.js";
import { change, clear, edit, redo, removePoint, shape, undo, useDrawing, usePath } from "./drawing.js";
import { usePen } from "./pen.js";
import { freeName, importFile, savePath, useSaved } from "./saved.js";
import { SavedPaths } from "./saved_list.js";
import { isPath, outside } from "./shape.js";
import { useSketch } from "./sketch.js";

/** @type {["freehand" | "points", string][]} */
const WAYS = [["freehand", "Freehand"], ["points", "Points"]];

export function DrawPanel({ close }) {
  usePen();
  useSketch();
  const { history, way, chosen, preview } = useDrawing((state) => state);
  const { points, closed, kind } = history.now;
  const ready = preview !== null && isPath(history.now);
  const choose = (part) => edit({ ...shape(), ...part });
  return html`
    <section class="tool-panel" aria-label="Draw a path">
      <div class="row">
        <fieldset class="segments">
          <legend class="unseen">Way to draw</legend>
          ${WAYS.map(([name, title]) => html`
            <label><input type="radio" name="draw-way" checked=${way === name} onChange=${() => change({ way: name })} /><span>${title}</span></label>
          `)}
        </fieldset>
        <label class="switch"><input type="checkbox" checked=${closed} onChange=${(event) => choose({ closed: event.target.checked })} />Closed</label>
        <label class="switch"><input type="checkbox" checked=${kind === "spline"} onChange=${(event) => choose({ kind: event.target.checked ? "spline" : "polyline" })} />Curved</label>
        <span class="row push">
          <button class="quiet" type="button" title="Ctrl + Z" disabled=${history.past.length === 0} onClick=${undo}>Undo</button>
          <button class="quiet" type="button" title="Ctrl + Y" disabled=${history.future.length === 0} onClick=${redo}>Redo</button>
          ${chosen >= 0 && html`<button class="quiet" type="button" title="Delete" onClick=${() => removePoint(chosen)}>Remove point</button>`}
          <button class="quiet" type="button" disabled=${points.length === 0} onClick=${clear}>Clear</button>
        </span>
      </div>
      <${Facts} />
      <div class="row">
        <button class="next" type="button" disabled=${!ready} onClick=${usePath}>Use this path</button>
        <${Save} ready=${ready} />
        <${Import} />
        <button class="quiet push" type="button" onClick=${close}>Done</button>
      </div>
      <${SavedPaths} names=${useSaved()} />
    </section>
  `;
}

/** Length and time, or what is wrong; what has become of it. */
function Facts() {
  const { history, preview, refusal, done } = useDrawing((state) => state);
  const gait = useStore((state) => state.selection?.gait);
  const half = useStore((state) => (state.rig?.limits?.workspace_mm ?? 0) / 2);
  const shown = history.now;
  const beyond = half ? outside(shown, half).length : 0;
  if (shown.points.length === 0) return html`<p class="tool-facts hint">Nothing is drawn yet. The dashed square is where the robot may walk.</p>`;
  const count = `${shown.points.length} ${shown.points.length === 1 ? "point" : "points"}`;
  const wrong = beyond > 0 ? `${beyond === 1 ? "One point lies" : `${beyond} points lie`} outside the workspace, ±${half} mm: move ${beyond === 1 ? "it" : "them"} inside.` : refusal;
  return html`
    <p class="tool-facts" aria-live="polite">
      ${wrong ? html`<span class="field-error">${wrong}</span>` : html`
        ${preview && html`<span>${quantity(preview.length_mm, "mm", 0)} long</span>`}
        ${preview && gait && html`<span>${clock(passTime(preview, gait))} min a pass</span>`}
        <span class="soft">${count}</span>
        ${done && html`<span class="good">✓ ${done}</span>`}`}
    </p>
  `;
}

function Save({ ready }) {
  const [name, setName] = useState(null);
  const [error, setError] = useState("");
  const begin = () => {
    setName(freeName());
    setError("");
  };
  if (name === null) return html`<button type="button" disabled=${!ready} onClick=${begin}>Save as…</button>`;
  const save = async (event) => {
    event.preventDefault();
    const refused = await savePath(name.trim());
    setError(refused);
    if (!refused) setName(null);
  };
  return html`
    <form class="name-form" onSubmit=${save}>
      <input type="text" aria-label="Name of the path" maxlength="60" required autocomplete="off" value=${name} onInput=${(event) => setName(event.target.value)} ref=${selectOnce} />
      <button type="submit" disabled=${!ready || name.trim() === ""}>Save</button>
      <button class="quiet" type="button" onClick=${() => setName(null)}>Cancel</button>
      ${error && html`<p class="field-error" role="alert">${error}</p>`}
    </form>
  `;
}

/** The proposed name is replaced by what is typed. */
function selectOnce(input) {
  if (!input || input.dataset.seen) return;
  input.dataset.seen = "yes";
  input.select();
}

function Import() {
  const take = (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (file) importFile(file);
  };
  return html`
    <label class="import" title="CSV with x and y in mm a line, or JSON: [[x, y], …]">
      <input class="unseen" type="file" accept=".csv,.txt,.json,text/plain" aria-label="Import points from a file" onChange=${take} />Import…
    </label>
  `;
}
