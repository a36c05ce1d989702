/** Above the charts: how far back they look, pause, what happened where one points, which ones there are, download. */
import { download } from "../download.js";
import { useKeys } from "../keys/bindings.js";
import { onTick, live } from "../live/ticks.js";
import { fixed } from "../units.js";
import { html, useEffect, useState } from "../view.js";
import { csvParts } from "./csv.js";
import { CHARTS } from "./curves.js";
import { Pointed } from "./pointed.js";
import { WINDOWS } from "./span.js";
import { leaveZoom, lookBack, span, toggleChart, togglePause, useView, view } from "./view.js";

export function Toolbar() {
  const { window_s, zoom, folded, held } = useView();
  const still = held !== null || zoom !== null;
  useKeys("Charts", [{ key: "p", words: still ? "Charts: go on with what is new" : "Charts: stand still", act: togglePause }]);
  return html`
    <div class="charts-tools" role="toolbar" aria-label="Charts">
      <fieldset class="segments" data-still=${still}>
        <legend class="unseen">How far back the charts look</legend>
        ${WINDOWS.map(([seconds, words]) => html`
          <label><input type="radio" name="charts-window" checked=${!still && seconds === window_s} onClick=${() => lookBack(seconds)} /><span>${words}</span></label>
        `)}
      </fieldset>
      <button class="small" type="button" aria-pressed=${still} aria-keyshortcuts="P" onClick=${togglePause}>${still ? "Go live" : "Pause"}</button>
      ${zoom !== null && html`<button class="small" type="button" onClick=${leaveZoom}>Leave zoom</button>`}
      ${still && html`<${Behind} />`}
      <${Pointed}>${!still && html`<span class="hint charts-hint">drag to look closer</span>`}<//>
      <span class="charts-choice" role="group" aria-label="Charts shown">
        ${CHARTS.map(({ title }) => html`
          <button class="chip" type="button" aria-pressed=${!folded.includes(title)} onClick=${() => toggleChart(title)}>${title}</button>
        `)}
      </span>
      <button class="quiet" type="button" title="What the charts show, as a table (CSV)" onClick=${save}>Download</button>
    </div>
  `;
}

/** How far what is shown lies behind what is new, which goes on meanwhile. */
function Behind() {
  const [behind_s, setBehind] = useState(0);
  useEffect(() => {
    const tell = () => setBehind(Math.floor((live.history.newest_s || 0) - span()[1]));
    tell();
    return onTick(tell);
  }, []);
  return html`<span class="charts-behind" role="note">standing still · ${fixed(behind_s, 0)} s behind</span>`;
}

function save() {
  const shown = CHARTS.filter(({ title }) => !view().folded.includes(title)).flatMap(({ curves }) => curves);
  const names = shown.filter(({ group }) => !view().hidden.includes(group)).map(({ column }) => column);
  download(fileName(), csvParts(live.history.rows, span(), names), "text/csv");
}

/** Named by the time of its end on the clock on the wall. */
const fileName = () => `pivotrig-charts-${new Date((span()[1] + live.clock_s) * 1000).toISOString().slice(0, 19).replaceAll(":", "-")}.csv`;
