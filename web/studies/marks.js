/** Lines differ by the shape of their marks, too, so that nobody needs to tell the colours apart. */
import { html } from "../view.js";

const SHAPES = [
  "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
  "M-3.6-3.6h7.2v7.2h-7.2z",
  "M0-4.8L4.6 3.4H-4.6z",
  "M0-5L5 0L0 5L-5 0z",
  "M0 4.8L4.6-3.4H-4.6z",
  "M-4.6-1.5h3.1v-3.1h3v3.1h3.1v3h-3.1v3.1h-3v-3.1h-3.1z",
  "M-5-2.4h10v4.8h-10z",
];

export const Mark = ({ index, x, y, title }) => html`
  <path class="mark" data-line=${index % SHAPES.length} d=${SHAPES[index % SHAPES.length]} transform=${`translate(${x.toFixed(1)} ${y.toFixed(1)})`}>${title && html`<title>${title}</title>`}</path>
`;
