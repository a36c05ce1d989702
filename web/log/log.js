/** The log of the server's session: open faults on top, then what happened, newest first. */
import { inspect } from "../runs/inspected.js";
import { showTab } from "../journal/tab.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { loadEvents, loadOlder, seeAll, useLog } from "./listing.js";
import { Tools } from "./tools.js";
import { ageOf, clockOf, lasting, matching, severityWord } from "./words.js";

const AGES_MS = 5000;

export function Log() {
  const filter = useLog(({ severity, text }) => ({ severity, text }));
  const { error } = useLog((log) => log);
  const events = useStore((state) => state.events);
  const [held, setHeld] = useState(null);
  const list = useRef(null);
  useEffect(seeAll, [events]);
  const follow = () => {
    const isAway = list.current.scrollTop > 4;
    if (isAway !== (held !== null)) setHeld(isAway ? (events[0]?.number ?? 0) : null);
  };
  const found = matching(events, filter);
  const shown = held === null ? found : found.filter(({ number }) => number <= held);
  const waiting = found.length - shown.length;
  return html`
    <section class="log-page" aria-label="Log">
      <${Tools} found=${found} />
      <${OpenFaults} />
      ${error && html`<p class="padded field-error" role="alert">${error} <button type="button" onClick=${loadEvents}>Try again</button></p>`}
      ${waiting > 0 && html`<p class="log-fresh"><button type="button" onClick=${() => list.current.scrollTo({ top: 0 })}>${waiting} newer ${waiting === 1 ? "line" : "lines"}</button></p>`}
      <div class="log-scroll" ref=${list} onScroll=${follow} tabindex="0" role="group" aria-label="Lines of the log">
        <${Lines} events=${shown} all=${events.length} />
        <${Older} />
      </div>
    </section>
  `;
}

function OpenFaults() {
  const faults = useStore((state) => state.tick?.faults ?? []);
  if (faults.length === 0) return null;
  return html`
    <ul class="log-open" aria-label="Open faults">
      ${faults.map(({ code, message, since_s: since }) => html`
        <li key=${code}><strong>${message}</strong><span class="soft">for ${lasting(since)}</span></li>`)}
    </ul>
  `;
}

/** Ages grow while nothing happens. */
function useNow() {
  const [now, setNow] = useState(() => new Date());
  useEffect(() => {
    const timer = setInterval(() => setNow(new Date()), AGES_MS);
    return () => clearInterval(timer);
  }, []);
  return now;
}

function Lines({ events, all }) {
  const now = useNow();
  if (events.length === 0) return html`<p class="hint padded">${all > 0 ? "No line is like that." : "Nothing has happened yet."}</p>`;
  return html`<ol class="log">${events.map((event) => html`<${Line} key=${event.number} event=${event} now=${now} />`)}</ol>`;
}

function Line({ event, now }) {
  const { at, time_s: time, severity, message, code, run_id: run } = event;
  return html`
    <li data-severity=${severity}>
      <time datetime=${at} title=${`${new Date(at).toLocaleString("en-GB")}, rig time ${time.toFixed(1)} s`}>${clockOf(at, now)} <span class="soft">${ageOf(at, now)}</span></time>
      <span class="severity">${severityWord(severity)}</span>
      <span class="log-words">${message}${run && html` <${RunLink} id=${run} />`}</span>
      <code>${code}</code>
    </li>
  `;
}

function RunLink({ id }) {
  const open = () => {
    showTab("runs");
    inspect(id);
  };
  return html`<button class="quiet link" type="button" aria-label=${`Show the run ${id}`} title=${`It happened in the run ${id}`} onClick=${open}>in run ${id}</button>`;
}

function Older() {
  const { next, loading } = useLog((log) => log);
  if (next === null) return null;
  return html`<p class="show-more"><button type="button" disabled=${loading} onClick=${loadOlder}>${loading ? "Loading…" : "Show older lines"}</button></p>`;
}
