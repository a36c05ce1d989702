/** A small map of the picture: where the board has been. */
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html } from "../view.js";

/** Fields of the map, across; down as many as the picture's shape gives. */
const ACROSS = 12;
const DEFAULT_SIZE = [640, 480];
/** A field with more corners than this is full, and darker. */
const FULL = 8;

export function CoverageMap({ session }) {
  const size = useStore((state) => state.camera?.size) ?? DEFAULT_SIZE;
  const side = size[0] / ACROSS;
  const down = Math.round(size[1] / side);
  const share = `${fixed(session.coverage * 100, 0)} %`;
  return html`
    <figure class="coverage">
      <svg viewBox=${`0 0 ${ACROSS} ${down}`} role="img" aria-label=${`Where the board has been: ${session.views} views, ${share} of the picture`}>
        <rect width=${ACROSS} height=${down} class="coverage-ground" />
        ${counts(session.covered_px, side, down).map((count, index) => count > 0 && html`
          <rect x=${(index % ACROSS) + 0.06} y=${Math.floor(index / ACROSS) + 0.06} width="0.88" height="0.88" class="coverage-field" data-full=${count > FULL} />
        `)}
      </svg>
      <figcaption>
        <strong>${session.views}</strong> <span class="soft">${session.views === 1 ? "view" : "views"}</span>
        <strong>${share}</strong> <span class="soft">of the picture covered</span>
      </figcaption>
    </figure>
  `;
}

function counts(points, side, down) {
  const visits = new Array(ACROSS * down).fill(0);
  for (const [u, v] of points) {
    const index = Math.floor(v / side) * ACROSS + Math.floor(u / side);
    if (index >= 0 && index < visits.length) visits[index] += 1;
  }
  return visits;
}
