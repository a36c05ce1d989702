/** `?` shows the keys that work just now. */
import { Ask } from "../ask.js";
import { startTour } from "../tour/start.js";
import { html, useState } from "../view.js";
import { useKeys } from "./bindings.js";
import { sheet, signsOf } from "./register.js";

/** What a browser or STOP heeds; everything else is told by who offers it. */
const ALWAYS = [
  ["STOP", [
    [["Escape"], "Coils to zero: from anywhere, also with this sheet open"],
    [["Space"], "The same, except while typing in a text field (press buttons with Enter)"],
  ]],
  ["Getting around", [
    [["Tab"], "Next control; with Shift the one before"],
    [["Enter"], "Press the focused button, take over the focused value"],
  ]],
];

/** @typedef {import("./register.js").Binding} Binding */

/** @returns {[string, [string[], string][]][]} */
const offered = () => sheet().map(([group, list]) => [group, list.map((binding) => [signsOf(binding), binding.words])]);

export function KeySheet() {
  const [open, setOpen] = useState(false);
  const close = () => setOpen(false);
  const showTour = () => {
    close();
    startTour();
  };
  useKeys("Getting around", [{ key: "?", words: "This sheet", act: () => setOpen(true) }]);
  return html`
    <button class="quiet keys-button" type="button" aria-haspopup="dialog" onClick=${() => setOpen(true)}>Keys <kbd>?</kbd></button>
    ${open && html`<${Ask} title="Keys" close=${close}><${Groups} />
      <div class="choice">
        <button type="button" data-first onClick=${close}>Close</button>
        <button type="button" onClick=${showTour}>Show the tour</button>
      </div>
    <//>`}
  `;
}

function Groups() {
  /** @type {Map<string, [signs: string[], words: string][]>} */
  const groups = new Map(/** @type {any} */ (ALWAYS));
  for (const [group, rows] of offered()) groups.set(group, [...(groups.get(group) ?? []), ...rows]);
  return html`
    <div class="keys">
      ${[...groups].map(([group, rows]) => html`
        <section aria-label=${group}>
          <h3>${group}</h3>
          <dl>${rows.map(([signs, words]) => html`<div><dt>${signs.map((sign) => html`<kbd>${sign}</kbd> `)}</dt><dd>${words}</dd></div>`)}</dl>
        </section>`)}
    </div>
  `;
}
