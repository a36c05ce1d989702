/** Paints picture and overlay into one canvas, at the screen's own resolution, when either has changed. */
import { get } from "../store.js";
import { live, onTick } from "../live/ticks.js";
import { keepOpen } from "../live/socket.js";
import { drawOverlay } from "./overlay.js";
import { projection } from "./projection.js";

/** Pictures are asked for at most this often: more cannot be told apart and costs the rig's computer, ms. */
const PICTURE_MS = 33;
/** The overlay moves with the pictures; without any for this long it moves by itself, s. */
const ALONE_S = 0.1;

/**
 * @param {HTMLCanvasElement} canvas
 * @returns painter with `show({view, overlay})`, `age_s()` of the newest picture, and `close()`
 */
export function createPainter(canvas) {
  const context = canvas.getContext("2d");
  const painter = { picture: null, overlay: true, model: null, project: null, receivedAt: null };
  let requested = 0;
  let frames = null;
  let asked = 0;
  let askForNext = null;

  function invalidate() {
    requested ||= requestAnimationFrame(paint);
  }

  function paint() {
    requested = 0;
    fit(canvas);
    const size = get().camera?.size ?? (painter.picture ? [painter.picture.width, painter.picture.height] : null);
    if (size) paintScaled(context, painter, size);
    askForNext?.();
    askForNext = null;
  }

  async function receive(data, send) {
    const picture = await createImageBitmap(data).catch(() => null);
    if (picture) {
      painter.picture?.close();
      painter.picture = picture;
      painter.receivedAt = performance.now();
    }
    // The next picture is asked for once this one is on the screen: a hidden page asks for none.
    const rest = PICTURE_MS - (performance.now() - asked);
    askForNext = () => setTimeout(() => {
      asked = performance.now();
      send("ok");
    }, rest);
    invalidate();
  }

  function show({ view, overlay }) {
    painter.overlay = overlay;
    if (painter.view !== view) {
      frames?.close();
      frames = keepOpen(`/api/v1/camera?view=${view}`, { message: receive });
      painter.view = view;
    }
    invalidate();
  }

  const resized = new ResizeObserver(invalidate);
  resized.observe(canvas);
  const forgetTicks = onTick(() => (pictureAge(painter) ?? 1) > ALONE_S && invalidate());
  const close = () => {
    cancelAnimationFrame(requested);
    resized.disconnect();
    forgetTicks();
    frames?.close();
  };
  return { show, close, age_s: () => pictureAge(painter) };
}

function pictureAge({ receivedAt }) {
  return receivedAt === null ? null : (performance.now() - receivedAt) / 1000;
}

function fit(canvas) {
  const scale = devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * scale));
  const height = Math.max(1, Math.round(canvas.clientHeight * scale));
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
}

function paintScaled(context, painter, [width, height]) {
  const { canvas } = context;
  const scale = Math.min(canvas.width / width, canvas.height / height);
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.setTransform(scale, 0, 0, scale, (canvas.width - scale * width) / 2, (canvas.height - scale * height) / 2);
  if (painter.picture) context.drawImage(painter.picture, 0, 0, width, height);
  if (painter.overlay) paintOverlay(context, painter, (devicePixelRatio || 1) / scale);
}

function paintOverlay(context, painter, pixel) {
  const { camera, path, runPath, rig } = get();
  if (!camera?.model) return;
  if (painter.model !== camera.model) {
    painter.model = camera.model;
    painter.project = projection(camera.model);
  }
  drawOverlay(context, pixel, {
    project: painter.project,
    bodyHeight_mm: camera.model.body_height_mm ?? 0,
    length_mm: rig?.robot?.length_mm,
    path: (runPath ?? path)?.points_mm,
    tick: live.tick,
    trail: live.trail,
    size: camera.size,
  });
}
