/** The tab of runs: find them, look at them, replay, compare, take away, tidy up. */
import { useStore } from "../store.js";
import { html, useEffect, useRef } from "../view.js";
import { Details } from "./details.js";
import { Filters } from "./filters.js";
import { Foot } from "./foot.js";
import { isFiltered, more, search, useListing } from "./listing.js";
import { SHEET } from "./sheet.js";
import { Table } from "./table.js";

export function Runs() {
  const opened = useStore((state) => state.inspected?.id ?? null);
  return html`
    <div class="runs" data-details=${opened !== null}>
      <section class="runs-list" aria-label="Runs">
        <${Filters} />
        <${List} opened=${opened} />
        <${Foot} />
      </section>
      ${opened !== null && html`<${Details} key=${opened} />`}
    </div>
  `;
}

function List({ opened }) {
  const { runs, ticked, error, filter } = useListing((listing) => listing);
  const trouble = error && html`<p class="padded field-error" role="alert">${error} <button type="button" onClick=${search}>Try again</button></p>`;
  if (trouble && runs === null) return trouble;
  if (runs === null) return html`<p class="hint padded">Loading the runs…</p>`;
  if (runs.length === 0) return html`<p class="hint padded">${isFiltered(filter) ? "No run is like that." : "No run yet. Arm the rig and start one."}</p>`;
  return html`${trouble}<div class="runs-scroll"><${Table} runs=${runs} ticked=${ticked} opened=${opened} /><${More} /></div>`;
}

/** Comes by itself when its place is reached; on a phone only by a touch, since the foot of the list comes after it. */
function More() {
  const { next, loading, error } = useListing((listing) => listing);
  const place = useRef(null);
  useEffect(() => {
    // What cannot be had now is not asked for again and again.
    if (next === null || loading || error || SHEET.matches) return undefined;
    const inView = new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && more());
    inView.observe(place.current);
    return () => inView.disconnect();
  }, [next, loading, error]);
  if (next === null) return null;
  return html`<p class="show-more" ref=${place}><button type="button" disabled=${loading} onClick=${more}>Show more</button></p>`;
}
