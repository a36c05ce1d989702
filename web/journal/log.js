/** What happened since this page was opened, newest first; open faults on top. */
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html } from "../view.js";

export function Log() {
  const events = useStore((state) => state.events);
  const faults = useStore((state) => state.tick?.faults ?? []);
  if (events.length + faults.length === 0) return html`<p class="hint padded">Nothing has happened since this page was opened.</p>`;
  return html`
    <ol class="log">
      ${faults.map((fault) => html`<${Line} severity="fault" time=${`for ${fixed(fault.since_s, 0)} s`} text=${fault.message} code=${fault.code} />`)}
      ${events.map((event) => html`<${Line} severity=${event.severity} time=${`at ${fixed(event.time_s, 1)} s`} text=${event.message} code=${event.code} />`)}
    </ol>
  `;
}

function Line({ severity, time, text, code }) {
  return html`
    <li data-severity=${severity}>
      <span class="soft">${time}</span><span class="severity">${severity}</span><span>${text}</span><code>${code}</code>
    </li>
  `;
}
