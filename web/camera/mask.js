/** Which pixels of the picture a colour takes in, made here in the page, so that it follows a slider at once. */

/** Pixels across the mask: enough to see a robot's shape, few enough for a phone. */
const WIDTH = 320;
/** The mask is made again at most this often, ms. */
const PERIOD_MS = 100;
const CHOSEN = [86, 180, 233, 205];
const REST = [8, 12, 16, 150];

/** @returns draw({context, picture, size}, colour): everything but the colour goes dark */
export function createMask() {
  const small = document.createElement("canvas");
  const pen = /** @type {CanvasRenderingContext2D} */ (small.getContext("2d", { willReadFrequently: true }));
  let madeAt = -Infinity;
  let madeOf = null;
  return ({ context, picture, size }, colour) => {
    if (!picture) return;
    if (performance.now() - madeAt > PERIOD_MS || madeOf !== colour) {
      small.width = Math.min(WIDTH, size[0]);
      small.height = Math.round((small.width * size[1]) / size[0]);
      pen.drawImage(picture, 0, 0, small.width, small.height);
      const image = pen.getImageData(0, 0, small.width, small.height);
      paintMask(image.data, colour);
      pen.putImageData(image, 0, 0);
      madeAt = performance.now();
      madeOf = colour;
    }
    context.drawImage(small, 0, 0, size[0], size[1]);
  };
}

/** In place: RGBA pixels to the colours of the mask. */
export function paintMask(pixels, colour) {
  for (let index = 0; index < pixels.length; index += 4) {
    pixels.set(matches(pixels[index], pixels[index + 1], pixels[index + 2], colour) ? CHOSEN : REST, index);
  }
}

/** Whether red, green, blue (0..255) lie within hue (degrees, the low end above the high one: through red),
    saturation and value (0..255), as OpenCV defines them. */
export function matches(red, green, blue, { hue_deg: hues, saturation, value }) {
  const most = Math.max(red, green, blue);
  const spread = most - Math.min(red, green, blue);
  const strength = most === 0 ? 0 : (255 * spread) / most;
  if (!between(most, value) || !between(strength, saturation)) return false;
  const hue = hueOf(red, green, blue, most, spread);
  return hues[0] <= hues[1] ? between(hue, hues) : hue >= hues[0] || hue <= hues[1];
}

const between = (value, [low, high]) => low <= value && value <= high;

function hueOf(red, green, blue, most, spread) {
  if (spread === 0) return 0;
  if (most === red) return (60 * (green - blue) / spread + 360) % 360;
  return most === green ? 120 + (60 * (blue - red)) / spread : 240 + (60 * (red - green)) / spread;
}
