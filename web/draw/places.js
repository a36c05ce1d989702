/** What of the drawn path lies under a place of the picture, and where on the plate that is. */
import { projection, unprojection } from "../camera/projection.js";
import { get } from "../store.js";
import { drawing, shape } from "./drawing.js";
import { toSide } from "./shape.js";
import { distance } from "./smoothing.js";

/** A press this near to a point takes hold of it, and to the line puts one on it, CSS px. */
const REACH = 14;
const LINE_REACH = 8;

/** @returns {[number, number] | null} mm; null beside the plate's plane, and while the camera is not known */
export function onPlate({ u, v }) {
  const { camera } = get();
  return camera && unprojection(camera.model)(u, v);
}

/** Where points of the plate lie in the picture, px. */
function seen(points) {
  const { camera } = get();
  if (!camera) return [];
  const project = projection(camera.model);
  return points.map(([x, y]) => project(x, y));
}

/** Index of the point under the pointer, -1 for none. */
export function pointAt(place) {
  const far = seen(shape().points).map((point) => distance(point, [place.u, place.v]));
  const nearest = far.indexOf(Math.min(...far));
  return far[nearest] <= REACH * place.pixel ? nearest : -1;
}

/** @param {import("../camera/pointing.js").Place} place */
export function isOnLine(place) {
  const line = seen(drawing().preview?.points_mm ?? []);
  return line.some((point, index) => index > 0 && toSide([place.u, place.v], line[index - 1], point) <= LINE_REACH * place.pixel);
}
