/** Paints picture and overlay into one canvas, at the screen's own resolution, when either has changed. */
import { drawOverlay } from "./overlay.js";
import { ALONE } from "./pointing.js";
import { projection } from "./projection.js";
import { createSight } from "./sight.js";
import { placed } from "./viewport.js";
import { createZoom } from "./zoom.js";

/** The overlay moves with the pictures; without any for this long it moves by itself, s. */
const ALONE_S = 0.1;
/** From this size on, device px, a camera pixel is shown as the square that it is. */
const PIXEL_SEEN = 4;

/**
 * @param {HTMLCanvasElement} canvas
 * @param source where pictures come from and what is drawn over them (the rig's: camera/rig_pictures.js):
 *        camera() -> {size, model} or null; open(view, show) -> {close}, with show(image data or null, then, about) for
 *        each picture and then() called once it is on the screen; onChange(listener) and onLayers(listener) -> forget;
 *        layers() to draw under the overlay; over(about) -> {path, trail, tick, length_mm}, about: of the picture shown
 * @param {import("./zoom.js").Zoom} zoom which part of the picture is shown
 * @returns painter with `show({view, overlay})`, `age_s()` of the newest picture, its `sight`, and `close()`
 */
export function createPainter(canvas, source, zoom = createZoom()) {
  const context = canvas.getContext("2d");
  /** @type {any} */
  const painter = { source, zoom, picture: null, about: undefined, overlay: true, model: null, project: null, receivedAt: null };
  let requested = 0;
  /** @type {{close: () => void} | null} */
  let frames = null;
  /** @type {(() => void) | null} */
  let tellShown = null;

  function invalidate() {
    requested ||= requestAnimationFrame(paint);
  }

  function paint() {
    requested = 0;
    fit(canvas);
    const size = sizeOf(painter);
    if (size) paintScaled(context, painter, size);
    tellShown?.();
    tellShown = null;
  }

  async function receive(data, shown, about) {
    const picture = data && (await createImageBitmap(data).catch(() => null));
    if (picture || data === null) {
      painter.picture?.close();
      painter.picture = picture;
      painter.about = about;
      painter.receivedAt = performance.now();
    }
    tellShown = shown;
    invalidate();
  }

  function show({ view, overlay }) {
    painter.overlay = overlay;
    if (painter.view !== view) {
      frames?.close();
      frames = source.open(view, receive);
      painter.view = view;
    }
    invalidate();
  }

  const resized = new ResizeObserver(invalidate);
  resized.observe(canvas);
  const forgetChanges = source.onChange(() => (pictureAge(painter) ?? 1) > ALONE_S && invalidate());
  const forgetLayers = source.onLayers(invalidate);
  const forgetZoom = zoom.onChange(invalidate);
  const close = () => {
    cancelAnimationFrame(requested);
    resized.disconnect();
    forgetChanges();
    forgetLayers();
    forgetZoom();
    frames?.close();
  };
  return { show, close, age_s: () => pictureAge(painter), sight: createSight(canvas, zoom, () => sizeOf(painter)) };
}

function sizeOf({ source, picture }) {
  return source.camera()?.size ?? (picture ? [picture.width, picture.height] : null);
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
  const { scale, left, top } = placed(painter.zoom.get(), canvas, [width, height]);
  const pixel = (devicePixelRatio || 1) / scale;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.setTransform(scale, 0, 0, scale, left, top);
  context.imageSmoothingEnabled = scale < PIXEL_SEEN;
  if (painter.picture) context.drawImage(painter.picture, 0, 0, width, height);
  followModel(painter);
  const pen = { context, pixel, picture: painter.picture, size: [width, height], project: painter.project };
  const alone = [...painter.source.layers()].map((draw) => draw(pen)).includes(ALONE);
  if (painter.overlay && !alone) paintOverlay(context, painter, pixel);
}

function followModel(painter) {
  const model = painter.source.camera()?.model;
  if (!model || painter.model === model) return;
  painter.model = model;
  painter.project = projection(model);
}

function paintOverlay(context, painter, pixel) {
  const { source, about, project } = painter;
  const camera = source.camera();
  if (!camera?.model) return;
  drawOverlay(context, pixel, { ...source.over(about), project, size: camera.size, bodyHeight_mm: camera.model.body_height_mm ?? 0 });
}
