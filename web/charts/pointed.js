/** The time under the cursor that all charts share, and what happened then. */
import { live } from "../live/ticks.js";
import { fixed } from "../units.js";
import { html, useEffect, useState } from "../view.js";
import { clockTime } from "./clock_axis.js";
import { wordsNear } from "./marks.js";

const listeners = new Set();

/** A hook of uPlot. Charts that only follow the cursor tell the same. */
export function tellPointed(plot) {
  const { left } = plot.cursor;
  const pixel_s = (plot.scales.x.max - plot.scales.x.min) / (plot.over.clientWidth || 1);
  const told = left >= 0 ? { time_s: plot.posToVal(left, "x"), pixel_s } : null;
  for (const listener of listeners) listener(told);
}

/** In words: "14:03:22.4 · 12.3 s ago · run began"; children: what stands there while nobody points. */
export function Pointed({ children }) {
  const [pointed, setPointed] = useState(/** @type {{time_s: number, pixel_s: number} | null} */ (null));
  useEffect(() => {
    listeners.add(setPointed);
    return () => void listeners.delete(setPointed);
  }, []);
  if (pointed === null) return children;
  const { time_s, pixel_s } = pointed;
  const happened = wordsNear(time_s, pixel_s);
  return html`
    <span class="charts-pointed">
      ${clockTime(time_s + live.clock_s, 1)} <span class="soft">${fixed((live.history.newest_s || 0) - time_s, 1)} s ago</span>
      ${happened && html` <b>${happened}</b>`}
    </span>
  `;
}
