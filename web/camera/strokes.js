/** Colours and lines of what is drawn over the camera picture: each line on a dark seam, so that it holds on any. */

/** Okabe and Ito's, which hold for every kind of colour vision. */
export const COLOURS = {
  A: "#56b4e9", B: "#e69f00", path: "#0072b2", target: "#f0e442", trail: "#ffffff", axis: "#ffffff", seam: "#10151b",
  rival: "#cc79a7",
};

export function trace(context, points, goOn = false) {
  if (!goOn) context.beginPath();
  points.forEach(([u, v], index) => (index === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
}

export function stroke(context, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

export function seamed({ context, pixel }, colour, width) {
  stroke(context, COLOURS.seam, (width + 1.6) * pixel);
  stroke(context, colour, width * pixel);
}

export function letter({ context, pixel }, text, [u, v], colour = COLOURS[text]) {
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `600 ${12 * pixel}px system-ui, sans-serif`;
  context.lineWidth = 3 * pixel;
  context.strokeStyle = COLOURS.seam;
  context.strokeText(text, u, v);
  context.fillStyle = colour;
  context.fillText(text, u, v);
}
