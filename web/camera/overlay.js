/** What is drawn over the camera picture; shapes and letters say once more what the colours say. */
import { drawRobot } from "./robot_overlay.js";
import { COLOURS, letter, seamed, stroke, trace } from "./strokes.js";

const DEFAULT_LENGTH_MM = 10;
/** CSS px; around a robot, clear of its ends. */
const RIVAL_RADIUS = 22;

/**
 * @param {CanvasRenderingContext2D} context whose unit is one camera pixel
 * @param {number} pixel one CSS pixel in that unit
 * @param {{project: (x_mm: number, y_mm: number, height_mm?: number) => [number, number], bodyHeight_mm: number,
 *   length_mm?: number, path: any, tick: any, trail: any[], size: [number, number]}} scene
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
