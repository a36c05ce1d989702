/** What the help says: figure, words, equation. Loaded with all figures when somebody asks for the first time. */
import { html } from "../view.js";
import { helpFor } from "./help.js";
import { Written } from "./written.js";

/** @param {{of: string, name: string}} props */
export function Contents({ of, name }) {
  const entry = helpFor(of, name);
  if (entry === null) return html`<p class="hint">There is no more to say of it here.</p>`;
  return html`
    ${entry.Figure && html`<div class="help-figure">${entry.symbol && html`<span class="help-symbol"><${Written} text=${entry.symbol} /></span>`}<${entry.Figure} /></div>`}
    ${entry.words.map((text) => html`<p><${Written} text=${text} /></p>`)}
    ${entry.equation && html`<p class="help-equation"><${Written} text=${entry.equation} /></p>`}
  `;
}
