/** From the workspace plane to the picture: a pinhole camera with Brown's distortion, as OpenCV defines it. */

/**
 * @param model fx, fy, cx, cy in px; distortion [k1, k2, p1, p2, k3]; rotation row-major, workspace to camera;
 *              translation_mm
 * @returns {(x_mm: number, y_mm: number, height_mm?: number) => [number, number]} to (u, v) in px
 */
export function projection({ fx, fy, cx, cy, distortion, rotation: r, translation_mm: t }) {
  const [k1, k2, p1, p2, k3] = distortion;
  return (x, y, height = 0) => {
    const depth = r[6] * x + r[7] * y + r[8] * height + t[2];
    const a = (r[0] * x + r[1] * y + r[2] * height + t[0]) / depth;
    const b = (r[3] * x + r[4] * y + r[5] * height + t[1]) / depth;
    const square = a * a + b * b;
    const radial = 1 + square * (k1 + square * (k2 + square * k3));
    const bent = a * radial + 2 * p1 * a * b + p2 * (square + 2 * a * a);
    const bowed = b * radial + p1 * (square + 2 * b * b) + 2 * p2 * a * b;
    return [fx * bent + cx, fy * bowed + cy];
  };
}

/** Where the ends A (+1) and B (-1) stand: A lies along the local +y axis. */
export function pivotPoint({ x_mm, y_mm, heading_deg }, pivot, length_mm) {
  const heading = (heading_deg * Math.PI) / 180;
  const half = 0.5 * length_mm * pivot;
  return [x_mm - half * Math.sin(heading), y_mm + half * Math.cos(heading)];
}
