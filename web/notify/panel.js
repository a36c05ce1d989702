/** What this browser tells of by itself: asked for by a click, and explained before it is. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { setSound, tryOut, turnOff, turnOn } from "./device.js";

const WHEN = "A fault, the end of a study and the end of an unattended run, while this page is open but hidden or not in front.";
const REFUSALS = {
  denied: "This browser was told not to show notifications of this page; its settings of the site (left of the address) allow them again.",
  missing: "This browser shows notifications only of pages on its own computer or over https. A webhook reaches every device.",
};

export function Device() {
  const { on, sound, permission } = useStore((state) => state.notify);
  const active = on && permission === "granted";
  return html`
    <section class="rig-group" aria-label="On this device">
      <h3>On this device</h3>
      <p class="hint">${WHEN} The browser asks you first; nothing is sent anywhere.</p>
      ${REFUSALS[permission] && html`<p class="hint rig-note">${REFUSALS[permission]}</p>`}
      <div class="row">
        ${active
          ? html`<button type="button" onClick=${turnOff}>Turn notifications off</button><button type="button" onClick=${tryOut}>Show one now</button>`
          : html`<button type="button" disabled=${permission in REFUSALS} onClick=${turnOn}>Turn notifications on</button>`}
        <label class="switch"><input type="checkbox" checked=${sound} onChange=${(event) => setSound(event.target.checked)} />With a sound</label>
        <span class="soft" role="status">${active ? "On for this browser" : "Off for this browser"}</span>
      </div>
    </section>
  `;
}
