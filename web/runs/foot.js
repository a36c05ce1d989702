/** The foot of the list: what all runs take, and in its place what can be done with the ticked ones. */
import { openReplay } from "../replay/replay.js";
import { html, useState } from "../view.js";
import { DeleteDialog } from "./delete.js";
import { tickedRuns, untickAll, useListing } from "./listing.js";
import { PruneDialog } from "./prune.js";
import { bytes, counted, whyNothingToReplay } from "./words.js";

/** An hour with pictures takes about as much; below that somebody should know, bytes. */
const LITTLE_SPACE = 5e9;

/** One place for both, so that the list stays where it is. */
export function Foot() {
  const any = useListing((listing) => tickedRuns(listing).length > 0);
  return any ? html`<${Ticked} />` : html`<${Totals} />`;
}

function Ticked() {
  const ticked = useListing(tickedRuns);
  const [asking, ask] = useState(false);
  const why = whyNotCompared(ticked);
  return html`
    <div class="runs-foot ticked" role="group" aria-label="Ticked runs">
      <span>${counted(ticked.length, "run")} ticked</span>
      <button type="button" disabled=${why !== ""} title=${why} onClick=${() => openReplay(ticked.map(({ id }) => id))}>Compare</button>
      <button type="button" onClick=${() => ask(true)}>Delete…</button>
      <button class="quiet" type="button" onClick=${untickAll}>Untick</button>
      <span class="hint">${why}</span>
      ${asking && html`<${DeleteDialog} runs=${ticked} close=${() => ask(false)} />`}
    </div>
  `;
}

function whyNotCompared(ticked) {
  if (ticked.length !== 2) return "Tick two runs to compare them.";
  return ticked.map(whyNothingToReplay).find(Boolean) ?? "";
}

function Totals() {
  const totals = useListing((listing) => listing.totals);
  const [asking, ask] = useState(false);
  if (!totals) return html`<footer class="runs-foot"></footer>`;
  const little = totals.free_bytes !== null && totals.free_bytes < LITTLE_SPACE;
  return html`
    <footer class="runs-foot">
      <span>${counted(totals.runs, "run")} · ${bytes(totals.bytes)}${totals.pinned_bytes > 0 ? ` (${bytes(totals.pinned_bytes)} pinned)` : ""} · </span>
      <span class=${little ? "little-space" : ""}>${bytes(totals.free_bytes)} free${little ? ": little space, prune or move some" : ""}</span>
      <button class="quiet" type="button" disabled=${totals.runs === 0} onClick=${() => ask(true)}>Prune…</button>
      ${asking && html`<${PruneDialog} close=${() => ask(false)} />`}
    </footer>
  `;
}
