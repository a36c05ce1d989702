/** What the setup draws into the camera picture: points with numbers, outlines, found corners of a board. */

const SEAM = "#10151b";
const LINE = "#f0e442";
const POINT = "#e69f00";
const FOUND = "#56b4e9";

function seamed(context, pixel, colour, width) {
  context.lineJoin = "round";
  for (const [ink, wide] of [[SEAM, width + 1.6], [colour, width]]) {
    context.strokeStyle = ink;
    context.lineWidth = wide * pixel;
    context.stroke();
  }
}

/** A closed line through points, px; `open` leaves its end open. */
export function outline({ context, pixel }, points, { open = false } = {}) {
  if (points.length < 2) return;
  context.beginPath();
  points.forEach(([u, v], index) => (index === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
  if (!open) context.closePath();
  seamed(context, pixel, LINE, 2);
}

/** Points to be dragged: a ring with a dot in its centre, so that what it points at stays visible, and a number. */
export function numbered({ context, pixel }, points) {
  points.forEach(([u, v], index) => {
    context.beginPath();
    context.arc(u, v, 9 * pixel, 0, 2 * Math.PI);
    seamed(context, pixel, POINT, 2);
    context.beginPath();
    context.arc(u, v, 1.2 * pixel, 0, 2 * Math.PI);
    seamed(context, pixel, POINT, 1);
    number(context, pixel, String(index + 1), u + 16 * pixel, v - 14 * pixel);
  });
}

function number(context, pixel, text, u, v) {
  Object.assign(context, { textAlign: "center", textBaseline: "middle", font: `650 ${14 * pixel}px system-ui, sans-serif` });
  Object.assign(context, { lineWidth: 3.5 * pixel, strokeStyle: SEAM, fillStyle: POINT });
  context.strokeText(text, u, v);
  context.fillText(text, u, v);
}

/** Corners of the board, small. */
export function dots({ context, pixel }, points, strength = 1) {
  context.globalAlpha = strength;
  context.fillStyle = FOUND;
  for (const [u, v] of points) {
    context.beginPath();
    context.arc(u, v, 2.5 * pixel, 0, 2 * Math.PI);
    context.fill();
  }
  context.globalAlpha = 1;
}
