/** The error of a run over its time, as small as a word: from zero to its own largest value. */
import { fixed } from "../units.js";
import { html } from "../view.js";

const WIDTH = 96;
const HEIGHT = 22;
/** Half a stroke, so that the line is not cut at the edges. */
const EDGE = 1.5;

const isKnown = (value) => typeof value === "number" && Number.isFinite(value);

/** An SVG path; a gap where the error is not known. */
function pathOf(values, highest) {
  const x = (index) => EDGE + (index / Math.max(1, values.length - 1)) * (WIDTH - 2 * EDGE);
  const y = (value) => HEIGHT - EDGE - (highest > 0 ? value / highest : 0) * (HEIGHT - 2 * EDGE);
  let pen = "M";
  return values.map((value, index) => {
    if (!isKnown(value)) pen = "M";
    else {
      const piece = `${pen}${x(index).toFixed(1)},${y(value).toFixed(1)}`;
      pen = "L";
      return piece;
    }
    return "";
  }).join("");
}

export function Sparkline({ values }) {
  const known = (values ?? []).filter(isKnown);
  if (known.length < 2) return html`<span class="sparkline"></span>`;
  const highest = Math.max(...known);
  const words = `Error over the run, 0 to ${fixed(highest, 2)} mm`;
  return html`
    <svg class="sparkline" viewBox=${`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label=${words}>
      <title>${words}</title><path d=${pathOf(values, highest)} />
    </svg>
  `;
}
