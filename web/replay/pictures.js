/** What the camera card shows of a recording: its picture, and what was known when that picture was taken. */
import { projection } from "../camera/projection.js";
import { get } from "../store.js";
import { answer, onAnswer, onPicture } from "./line.js";
import { mayHavePictures, pathAt, trailTo } from "./recording.js";

const PLATE = { light: { ground: "#dfe4ea", plate: "#f7f9fb", edge: "#8a95a3" }, dark: { ground: "#10151b", plate: "#1f262d", edge: "#6d7986" } };
const DARK = matchMedia("(prefers-color-scheme: dark)");

/**
 * @param index of the run
 * @implements the source of `createPainter`
 */
export function recordedPictures(index) {
  const recording = () => get().replay?.runs[index] ?? null;
  return {
    camera: () => recording()?.camera ?? null,

    open(_, show) {
      if (!mayHavePictures(recording())) return { close() {} };
      return { close: onPicture(index, ({ image, about }) => show(image, () => {}, about)) };
    },

    onChange: onAnswer,
    onLayers: () => () => {},
    layers: () => [(pen) => pen.picture || drawPlate(pen, recording())],

    /** about: of the picture on the screen; the overlay shows its own instant, also when it is older than the rest. */
    over(about) {
      const run = recording();
      const tick = about?.tick ?? answer.ticks[index] ?? null;
      const time = about?.tick ? about.time_s : answer.at_s;
      if (!run) return { path: null, trail: [], tick: null };
      return { path: pathAt(run, time), trail: trailTo(run, time, tick?.pose), tick, length_mm: run.length_mm };
    },
  };
}

/** The plate alone, where there is no picture. */
function drawPlate({ context, pixel, size }, run) {
  if (!run) return;
  const look = DARK.matches ? PLATE.dark : PLATE.light;
  const project = projection(run.camera.model);
  const half = run.half_mm;
  context.fillStyle = look.ground;
  context.fillRect(0, 0, ...size);
  context.beginPath();
  for (const [x, y] of [[-half, -half], [half, -half], [half, half], [-half, half]]) context.lineTo(...project(x, y));
  context.closePath();
  context.fillStyle = look.plate;
  context.strokeStyle = look.edge;
  context.lineWidth = pixel;
  context.fill();
  context.stroke();
}
