/** The sign of a pinned run, and what it means. */
import { html } from "../view.js";

export const PINNED = "Pinned: neither deleted nor pruned. Click to unpin";
export const NOT_PINNED = "Pin: keep this run for ever";

export function Pin() {
  return html`<svg class="pin-sign" viewBox="0 0 16 16" aria-hidden="true"><path d="M5.5 1.5h5l-.8 4.6 2.8 2.6v1.3h-9V8.7l2.8-2.6zM8 10v4.8" /></svg>`;
}
