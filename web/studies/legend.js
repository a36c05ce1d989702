/** What the colours of the maps mean, with the unit. */
import { fixed } from "../units.js";
import { html, useId } from "../view.js";
import { GRADIENT } from "./scale.js";
import { metricTitle } from "./words.js";

export function Legend({ scale, metric }) {
  const id = useId();
  if (scale === null) return null;
  const digits = metric[3];
  return html`
    <p class="heat-legend">
      <span>${metricTitle(metric)}:</span>
      <span>${fixed(scale.low, digits)}</span>
      <svg width="120" height="12" role="img" aria-label="from little, dark, to much, light">
        <defs><linearGradient id=${id}>${GRADIENT.map(([offset, colour]) => html`<stop offset=${offset} stop-color=${colour} />`)}</linearGradient></defs>
        <rect width="120" height="12" rx="3" fill=${`url(#${id})`} />
      </svg>
      <span>${fixed(scale.high, digits)}</span>
    </p>
  `;
}
