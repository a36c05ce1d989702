/**
 * What is drawn over the camera picture. Colours are Okabe and Ito's, each line on a dark seam, so that they
 * hold on any picture and for every kind of colour vision; shapes and letters say the same a second time.
 */
import { pivotPoint } from "./projection.js";

const COLOURS = {
  A: "#56b4e9", B: "#e69f00", path: "#0072b2", target: "#f0e442", trail: "#ffffff", axis: "#ffffff", seam: "#10151b",
  rival: "#cc79a7",
};
const DEFAULT_LENGTH_MM = 10;
/** Length of the arrow that shows the heading, mm. */
const ARROW_MM = 8;
/** CSS px; around a robot, clear of its ends. */
const RIVAL_RADIUS = 22;

/**
 * @param context 2D context whose unit is one camera pixel; `pixel` is one CSS pixel in that unit
 * @param scene {project, bodyHeight_mm, length_mm, path, tick, trail, size}
 */
export function drawOverlay(context, pixel, scene) {
  const pen = { context, pixel, ...scene, length_mm: scene.length_mm ?? DEFAULT_LENGTH_MM };
  context.lineJoin = context.lineCap = "round";
  drawPath(pen);
  drawTrail(pen);
  if (!pen.tick) return;
  drawWindow(pen);
  drawRivals(pen);
  drawTarget(pen);
  drawRobot(pen);
}

function drawPath({ context, pixel, path, project }) {
  if (!path || path.length < 2) return;
  trace(context, path.map(([x, y]) => project(x, y)));
  context.setLineDash([6 * pixel, 5 * pixel]);
  stroke(context, COLOURS.path, 2 * pixel);
  context.setLineDash([]);
}

function drawTrail({ context, pixel, trail, project, bodyHeight_mm }) {
  if (trail.length < 2) return;
  trace(context, trail.map(([x, y]) => project(x, y, bodyHeight_mm)));
  seamed({ context, pixel }, COLOURS.trail, 1.5);
}

/** The searched region; not when it is the whole picture. */
function drawWindow({ context, pixel, tick, size }) {
  if (!tick.window_px) return;
  const [u0, v0, u1, v1] = tick.window_px;
  if (u1 - u0 >= size[0]) return;
  context.beginPath();
  context.rect(u0, v0, u1 - u0, v1 - v0);
  context.setLineDash([3 * pixel, 3 * pixel]);
  seamed({ context, pixel }, COLOURS.axis, 1);
  context.setLineDash([]);
}

/** What else looks like the robot: a ring, with a question mark while nobody knows which one it is. */
function drawRivals({ context, pixel, tick }) {
  for (const [u, v] of tick.rivals_px ?? []) {
    context.beginPath();
    context.arc(u, v, RIVAL_RADIUS * pixel, 0, 2 * Math.PI);
    seamed({ context, pixel }, COLOURS.rival, 2);
    if (tick.tracking !== "locked") letter({ context, pixel }, "?", [u + RIVAL_RADIUS * pixel, v - RIVAL_RADIUS * pixel], COLOURS.rival);
  }
}

function drawTarget({ context, pixel, tick, project }) {
  if (!tick.reference) return;
  const [u, v] = project(tick.reference.x_mm, tick.reference.y_mm);
  const radius = 6 * pixel;
  context.beginPath();
  context.arc(u, v, radius, 0, 2 * Math.PI);
  for (const [du, dv] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    context.moveTo(u + du * radius * 0.5, v + dv * radius * 0.5);
    context.lineTo(u + du * radius * 1.7, v + dv * radius * 1.7);
  }
  seamed({ context, pixel }, COLOURS.target, 2);
}

function drawRobot(pen) {
  const { context, pixel, tick, project, bodyHeight_mm, length_mm } = pen;
  if (!tick.pose) return;
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

function letter({ context, pixel }, text, [u, v], colour = COLOURS[text]) {
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `600 ${12 * pixel}px system-ui, sans-serif`;
  context.lineWidth = 3 * pixel;
  context.strokeStyle = COLOURS.seam;
  context.strokeText(text, u, v);
  context.fillStyle = colour;
  context.fillText(text, u, v);
}

function trace(context, points, goOn = false) {
  if (!goOn) context.beginPath();
  points.forEach(([u, v], index) => (index === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
}

function stroke(context, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

function seamed({ context, pixel }, colour, width) {
  stroke(context, COLOURS.seam, (width + 1.6) * pixel);
  stroke(context, colour, width * pixel);
}
