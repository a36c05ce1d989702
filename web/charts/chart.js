/** One uPlot chart over time; colours follow the page's tokens, light or dark. */
import uPlot from "../vendor/uplot/uPlot.mjs";
import { optionsOf } from "./options.js";
import { extent } from "./pixels.js";

/** A chart that is about to be scrolled into view is drawn already, CSS px. */
const MARGIN = "80px";

/**
 * @param {HTMLElement} box
 * @param {any[]} curves [{column, group, unit, colour, style, fromZero}] (charts/curves.js)
 * @param {any} source whose values (the rig's: charts/rig_source.js): columns(curves, pixels) -> [times, values…];
 *        range of the time axis, as uPlot asks for it; valuesAt(columns, pointed time or null, curves) for the legend;
 *        onChange(listener) of the values and onTime(listener) of the time -> forget; timeAxis {splits?, values};
 *        attach?(plot) -> detach, for what it draws and hears itself
 * @param {(values: (number | null)[], blank: boolean) => void} onValues one a curve, under the cursor or at the
 *        source's time; blank: there is nothing to draw at all
 * @returns {{hide: (groups: string[]) => void, close: () => void}} hide: the curves that are not drawn, by group
 */
export function createChart(box, curves, source, onValues) {
  let hidden = [];
  let inView = true;
  let [plot, detach] = build();

  /** @returns {[uPlot, () => void]} */
  function build() {
    const made = new uPlot({ ...optionsOf(curves, source), ...sizeOf(box) }, columns(), box);
    made.hooks.setCursor = [...(made.hooks.setCursor ?? []), () => inView && tell()];
    apply(made);
    return [made, source.attach?.(made) ?? (() => {})];
  }

  function columns() {
    return source.columns(curves, Math.max(1, box.clientWidth));
  }

  function apply(made) {
    curves.forEach(({ group }, index) => {
      const show = !hidden.includes(group);
      if (made.series[index + 1].show !== show) made.setSeries(index + 1, { show });
    });
  }

  function tell() {
    if (!plot) return;
    onValues(source.valuesAt(plot.data, pointedTime(plot), curves), extent(plot.data.slice(1)) === null);
  }

  const draw = () => inView && plot.setData(columns());
  const say = () => inView && tell();
  const forget = [source.onChange(draw), source.onTime(say)];
  tell();
  const seen = new IntersectionObserver(([{ isIntersecting }]) => {
    inView = isIntersecting;
    draw();
    say();
  }, { rootMargin: MARGIN });
  seen.observe(box);
  const resized = new ResizeObserver(() => box.clientWidth > 0 && plot.setSize(sizeOf(box)));
  resized.observe(box);
  const theme = matchMedia("(prefers-color-scheme: dark)");
  const away = () => {
    detach();
    plot.destroy();
  };
  const repaint = () => {
    away();
    [plot, detach] = build();
  };
  theme.addEventListener("change", repaint);
  return {
    hide(groups) {
      hidden = groups;
      apply(plot);
    },
    close() {
      for (const stop of forget) stop();
      seen.disconnect();
      resized.disconnect();
      theme.removeEventListener("change", repaint);
      away();
    },
  };
}

/** The time under the cursor, which all charts share; null while nobody points. */
function pointedTime(plot) {
  const { left } = plot.cursor;
  return typeof left === "number" && left >= 0 ? plot.posToVal(left, "x") : null;
}

const sizeOf = (box) => ({ width: Math.max(120, box.clientWidth), height: Math.max(80, box.clientHeight) });
