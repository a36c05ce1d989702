/** Between the workspace and the picture: a pinhole camera with Brown's distortion, as OpenCV defines it. Pure. */

/**
 * @typedef {{fx: number, fy: number, cx: number, cy: number, distortion: number[], rotation: number[],
 *   translation_mm: number[], body_height_mm?: number}} CameraModel fx, fy, cx, cy in px; distortion
 *   [k1, k2, p1, p2, k3]; rotation row-major, workspace to camera
 */

/**
 * @param {CameraModel} model
 * @returns {(x_mm: number, y_mm: number, height_mm?: number) => [number, number]} to (u, v) in px
 */
export function projection({ fx, fy, cx, cy, distortion, rotation: r, translation_mm: t }) {
  const bend = lens(distortion);
  return (x, y, height = 0) => {
    const depth = r[6] * x + r[7] * y + r[8] * height + t[2];
    const a = (r[0] * x + r[1] * y + r[2] * height + t[0]) / depth;
    const b = (r[3] * x + r[4] * y + r[5] * height + t[1]) / depth;
    const [bent, bowed] = bend(a, b);
    return [fx * bent + cx, fy * bowed + cy];
  };
}

/** Newton steps that straighten a ray; three do for the lenses of calibrations, strong ones take more. */
const STEPS = 20;
/** Straight enough, in focal lengths: a millionth of a pixel. */
const STRAIGHT = 1e-9;

/**
 * The way back: where the ray of a pixel meets the plane at a height over the workspace.
 * @param {CameraModel} model
 * @returns {(u: number, v: number, height_mm?: number) => [number, number] | null} to (x, y) in mm; null where the
 *   ray does not meet the plane before the camera
 */
export function unprojection({ fx, fy, cx, cy, distortion, rotation: r, translation_mm: t }) {
  const straighten = straightener(distortion);
  const along = (column, a, b, c) => r[column] * a + r[3 + column] * b + r[6 + column] * c;
  return (u, v, height = 0) => {
    const [a, b] = straighten((u - cx) / fx, (v - cy) / fy);
    const distance = (height + along(2, t[0], t[1], t[2])) / along(2, a, b, 1);
    if (!(distance > 0)) return null;
    const [p, q, w] = [distance * a - t[0], distance * b - t[1], distance - t[2]];
    return [along(0, p, q, w), along(1, p, q, w)];
  };
}

/** What the lens makes of a straight ray (a, b), at a focal length of one. @param {number[]} distortion */
function lens([k1, k2, p1, p2, k3]) {
  return (a, b) => {
    const square = a * a + b * b;
    const radial = 1 + square * (k1 + square * (k2 + square * k3));
    return [a * radial + 2 * p1 * a * b + p2 * (square + 2 * a * a), b * radial + p1 * (square + 2 * b * b) + 2 * p2 * a * b];
  };
}

/** The straight ray that the lens bends to (a, b), by Newton's method. */
function straightener(distortion) {
  const [k1, k2, p1, p2, k3] = distortion;
  const bend = lens(distortion);
  return (bent, bowed) => {
    let [a, b] = [bent, bowed];
    for (let step = 0; step < STEPS; step += 1) {
      const [nowA, nowB] = bend(a, b);
      const [missA, missB] = [nowA - bent, nowB - bowed];
      if (Math.hypot(missA, missB) < STRAIGHT) break;
      const square = a * a + b * b;
      const radial = 1 + square * (k1 + square * (k2 + square * k3));
      const growth = 2 * (k1 + square * (2 * k2 + 3 * square * k3));
      const aa = radial + growth * a * a + 2 * p1 * b + 6 * p2 * a;
      const ab = growth * a * b + 2 * p1 * a + 2 * p2 * b;
      const bb = radial + growth * b * b + 6 * p1 * b + 2 * p2 * a;
      const volume = aa * bb - ab * ab;
      a -= (bb * missA - ab * missB) / volume;
      b -= (aa * missB - ab * missA) / volume;
    }
    return [a, b];
  };
}

/** Where the ends A (+1) and B (-1) stand: A lies along the local +y axis. */
export function pivotPoint({ x_mm, y_mm, heading_deg }, pivot, length_mm) {
  const heading = (heading_deg * Math.PI) / 180;
  const half = 0.5 * length_mm * pivot;
  return [x_mm - half * Math.sin(heading), y_mm + half * Math.cos(heading)];
}
