/** The robot over the camera picture: its two ends by letter and colour, the pivot that is pressed down, its heading. */
import { pivotPoint } from "./projection.js";
import { COLOURS, letter, seamed, trace } from "./strokes.js";

/** Length of the arrow that shows the heading, mm. */
const ARROW_MM = 8;
const LOST_STRENGTH = 0.45;

/** Greyed where nobody sees it any more: it was there when it was seen last. */
export function drawRobot(pen) {
  const { context, pixel, tick, project, bodyHeight_mm, length_mm } = pen;
  if (!tick.pose) return;
  context.globalAlpha = tick.tracking === "lost" ? LOST_STRENGTH : 1;
  const at = (x, y) => project(x, y, bodyHeight_mm);
  const ends = { A: pivotPoint(tick.pose, 1, length_mm), B: pivotPoint(tick.pose, -1, length_mm) };
  trace(context, [at(...ends.B), at(...ends.A)]);
  seamed(pen, COLOURS.axis, 2);
  drawHeading(pen, at);
  const active = tick.command?.field_mT > 0 ? (tick.command.pivot === 1 ? "A" : "B") : null;
  const centre = at(tick.pose.x_mm, tick.pose.y_mm);
  for (const name of ["A", "B"]) drawEnd(pen, { name, end: at(...ends[name]), centre, active: name === active });
  context.setLineDash(tick.tracking === "locked" ? [] : [2 * pixel, 3 * pixel]);
  drawCentre(pen, centre);
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function drawHeading(pen, at) {
  const { x_mm, y_mm, heading_deg } = pen.tick.pose;
  const heading = (heading_deg * Math.PI) / 180;
  const from = at(x_mm, y_mm);
  const tip = at(x_mm + ARROW_MM * Math.cos(heading), y_mm + ARROW_MM * Math.sin(heading));
  const angle = Math.atan2(tip[1] - from[1], tip[0] - from[0]);
  const barb = (turn) => [tip[0] - 6 * pen.pixel * Math.cos(angle + turn), tip[1] - 6 * pen.pixel * Math.sin(angle + turn)];
  trace(pen.context, [from, tip]);
  trace(pen.context, [barb(0.5), tip, barb(-0.5)], true);
  seamed(pen, COLOURS.axis, 2);
}

function drawCentre({ context, pixel }, [u, v]) {
  context.beginPath();
  context.arc(u, v, 3 * pixel, 0, 2 * Math.PI);
  seamed({ context, pixel }, COLOURS.axis, 1.5);
}

/** An end as a disc with its letter beside it; the pivot that is pressed down is full and ringed. */
function drawEnd({ context, pixel }, { name, end: [u, v], centre, active }) {
  context.beginPath();
  context.arc(u, v, (active ? 5.5 : 4) * pixel, 0, 2 * Math.PI);
  context.fillStyle = active ? COLOURS[name] : COLOURS.seam;
  context.fill();
  seamed({ context, pixel }, COLOURS[name], 2);
  if (active) {
    context.beginPath();
    context.arc(u, v, 9 * pixel, 0, 2 * Math.PI);
    seamed({ context, pixel }, COLOURS[name], 1.5);
  }
  const reach = 17 / Math.max(1e-6, Math.hypot(u - centre[0], v - centre[1]));
  letter({ context, pixel }, name, [u + (u - centre[0]) * reach * pixel, v + (v - centre[1]) * reach * pixel]);
}
