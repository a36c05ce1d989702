/** What happened, as lines on the charts at its time, with its words where somebody points. */
import { live } from "../live/ticks.js";

/** Within this of the pointed time a mark is meant, CSS px. */
const NEAR_PX = 6;
const COLOURS = { run: "--ink-soft", info: "--line-strong", warn: "--warn-ink", fault: "--stop" };
/** At the top of a line: begin and end of runs are told from faults without colour, too. */
const FLAGS = { run: 3, info: 0, warn: 5, fault: 7 };

/** A hook of uPlot, after everything else is drawn. */
export function drawMarks(plot) {
  const { ctx, bbox } = plot;
  const { min, max } = plot.scales.x;
  const style = getComputedStyle(document.documentElement);
  ctx.save();
  for (const { time_s, kind } of live.marks) {
    if (!(min <= time_s && time_s <= max)) continue;
    const x = Math.round(plot.valToPos(time_s, "x", true));
    const size = FLAGS[kind] * devicePixelRatio;
    ctx.strokeStyle = ctx.fillStyle = style.getPropertyValue(COLOURS[kind]);
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash(kind === "run" ? [2, 3] : []);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.beginPath();
    ctx.moveTo(x - size, bbox.top);
    ctx.lineTo(x + size, bbox.top);
    ctx.lineTo(x, bbox.top + size * 1.4);
    ctx.fill();
  }
  ctx.restore();
}

/** Words of what happened about a time; "" where nothing did. */
export function wordsNear(time_s, pixel_s) {
  const near = live.marks.filter((mark) => Math.abs(mark.time_s - time_s) <= NEAR_PX * pixel_s);
  return [...new Set(near.map(({ words }) => words))].slice(-3).join(" · ");
}
