/** From one point of the plate to another. Pure. */

/**
 * @param {[number, number]} from mm @param {[number, number]} to mm
 * @returns {{distance_mm: number, dx_mm: number, dy_mm: number, angle_deg: number}} angle: from +x, anticlockwise
 */
export function measured([x, y], [p, q]) {
  const [dx_mm, dy_mm] = [p - x, q - y];
  return { distance_mm: Math.hypot(dx_mm, dy_mm), dx_mm, dy_mm, angle_deg: (Math.atan2(dy_mm, dx_mm) * 180) / Math.PI };
}
