/** The drawn path in the camera picture: the plate's limits, the curve that will be walked, its points. */
import { useLayer } from "../camera/pointing.js";
import { useStore } from "../store.js";
import { useDrawing } from "./drawing.js";
import { pen as hand } from "./pen.js";
import { outside } from "./shape.js";

const COLOURS = { seam: "#10151b", line: "#56b4e9", point: "#ffffff", chosen: "#f0e442", beyond: "#d55e00", limit: "#ffffff" };
const POINT_RADIUS = 4;
const TOUCHED_RADIUS = 6.5;
/** Pieces of each side of the limits, which a lens bends. */
const SIDE_PIECES = 12;
/** Length of the arrow that says which way the path is walked, CSS px. */
const ARROW = 9;

export function useSketch() {
  const { history, preview, chosen } = useDrawing((state) => state);
  const half = useStore((state) => (state.rig?.limits?.workspace_mm ?? 0) / 2);
  useLayer((pen) => {
    if (!pen.project) return;
    drawLimits(pen, half);
    if (hand.line) return drawLine(pen, hand.line, false);
    drawLine(pen, preview?.points_mm ?? history.now.points, preview === null);
    if (preview) drawArrow(pen, preview.points_mm);
    drawPoints(pen, history.now, chosen, half);
  }, [history, preview, chosen, half]);
}

function line({ context, pixel }, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width * pixel;
  context.stroke();
}

/** On a dark seam, which holds on any picture. */
function stroke(pen, colour, width) {
  pen.context.lineJoin = pen.context.lineCap = "round";
  line(pen, COLOURS.seam, width + 1.6);
  line(pen, colour, width);
}

function trace({ context, project }, points) {
  context.beginPath();
  points.map(([x, y]) => project(x, y)).forEach(([u, v], index) => (index === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
}

function drawLimits(pen, half) {
  if (!half) return;
  const steps = Array.from({ length: SIDE_PIECES }, (_, index) => -half + (2 * half * index) / SIDE_PIECES);
  const sides = [steps.map((at) => [at, -half]), steps.map((at) => [half, at]), steps.map((at) => [-at, half]), steps.map((at) => [-half, -at])];
  trace(pen, [...sides.flat(), [-half, -half]]);
  line(pen, COLOURS.seam, 2.4);
  pen.context.setLineDash([8 * pen.pixel, 6 * pen.pixel]);
  line(pen, COLOURS.limit, 1.4);
  pen.context.setLineDash([]);
}

/** uncertain: not yet, or not to be walked like this. */
function drawLine(pen, points, uncertain) {
  if (points.length < 2) return;
  trace(pen, points);
  pen.context.setLineDash(uncertain ? [2 * pen.pixel, 5 * pen.pixel] : []);
  stroke(pen, COLOURS.line, 2.5);
  pen.context.setLineDash([]);
}

/** A quarter of the way along, clear of both ends. */
function drawArrow(pen, points) {
  const at = Math.floor(points.length / 4);
  const [here, next] = [points[at], points[at + 1]].map((point) => point && pen.project(...point));
  if (!here || !next) return;
  const angle = Math.atan2(next[1] - here[1], next[0] - here[0]);
  const barb = (turn) => [here[0] - ARROW * pen.pixel * Math.cos(angle + turn), here[1] - ARROW * pen.pixel * Math.sin(angle + turn)];
  pen.context.beginPath();
  pen.context.moveTo(...barb(0.55));
  pen.context.lineTo(...here);
  pen.context.lineTo(...barb(-0.55));
  stroke(pen, COLOURS.line, 2.5);
}

function drawPoints(pen, shape, chosen, half) {
  const beyond = half ? new Set(outside(shape, half)) : new Set();
  shape.points.forEach(([x, y], index) => {
    const touched = index === hand.hovered || index === hand.held?.index;
    const colour = beyond.has(index) ? COLOURS.beyond : index === chosen ? COLOURS.chosen : COLOURS.point;
    drawPoint(pen, pen.project(x, y), colour, { touched, first: index === 0, beyond: beyond.has(index) });
  });
}

/** The first one is a square, one beyond the limits is crossed. */
function drawPoint(pen, [u, v], colour, { touched, first, beyond }) {
  const { context, pixel } = pen;
  const radius = (touched ? TOUCHED_RADIUS : POINT_RADIUS) * pixel;
  context.beginPath();
  if (first) context.rect(u - radius, v - radius, 2 * radius, 2 * radius);
  else context.arc(u, v, radius, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
  line(pen, COLOURS.seam, 1.4);
  if (!beyond) return;
  context.beginPath();
  for (const side of [-1, 1]) {
    context.moveTo(u - 2 * radius, v - 2 * side * radius);
    context.lineTo(u + 2 * radius, v + 2 * side * radius);
  }
  stroke(pen, COLOURS.beyond, 2);
}
