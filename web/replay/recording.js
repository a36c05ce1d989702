/** One recorded run, as the page needs it: who it is, its curves, its path, and the camera that saw it. */
import { COLUMNS, near } from "../live/ticks.js";
import { nameOf, partName, when } from "../runs/words.js";

/** The trail is as long as that of the rig itself, mm. */
const TRAIL_MM = 270;
const HALF_PLATE_MM = 60;

/**
 * @param run GET /runs/{id}
 * @param overview GET /runs/{id}/overview
 */
export function recordingOf(run, overview) {
  const series = columnsOf(overview.series ?? {});
  return {
    id: run.id, run, series,
    name: nameOf(run),
    parts: `${partName(run.controller)} · ${partName(run.trajectory)}`,
    started: when(run.started_at ?? overview.started_at),
    duration_s: overview.duration_s ?? series.time_s.at(-1) ?? 0,
    // Null: nobody has counted them, as in a torn recording.
    ticks: overview.ticks ?? null,
    frames: overview.frames ?? null,
    events: overview.events ?? [],
    isWhole: overview.is_whole !== false,
    paths: overview.paths ?? [],
    half_mm: overview.workspace?.half_mm ?? HALF_PLATE_MM,
    length_mm: overview.robot?.length_mm,
    camera: overview.camera ?? viewFromAbove(HALF_PLATE_MM),
  };
}

export const mayHavePictures = (recording) => recording !== null && recording.frames !== 0;

/** Every column of the charts, with nulls for what was not recorded, and angles on one turn. */
export function columnsOf(series) {
  const times = series.time_s ?? [];
  const unknown = times.map(() => null);
  const columns = Object.fromEntries(COLUMNS.map((name) => [name, series[name] ?? unknown]));
  const heading = unwound(columns.heading_deg);
  const beside = (name) => columns[name].map((angle, index) => near(angle, heading[index]));
  return {
    ...columns, time_s: times, heading_deg: heading,
    heading_measured_deg: beside("heading_measured_deg"), heading_goal_deg: beside("heading_goal_deg"),
  };
}

/** The same angles without jumps of a turn. */
function unwound(angles) {
  /** @type {number | null} */
  let last = null;
  return angles.map((angle) => {
    if (typeof angle !== "number") return null;
    last = near(angle, last);
    return last;
  });
}

/** A camera straight above the plate, for a recording that does not say where its own stood. */
function viewFromAbove(half_mm) {
  const size = [640, 480];
  const height_mm = 1000;
  const focal = (0.45 * size[1] * height_mm) / half_mm;
  return {
    size,
    model: {
      fx: focal, fy: focal, cx: size[0] / 2, cy: size[1] / 2, distortion: [0, 0, 0, 0, 0],
      rotation: [1, 0, 0, 0, -1, 0, 0, 0, -1], translation_mm: [0, 0, height_mm], body_height_mm: 0,
    },
  };
}

/** The path that was to be walked at a time, [[x, y]] in mm: another one may have been chosen on the way. */
export const pathAt = ({ paths }, time) => (paths.findLast((path) => path.time_s <= time) ?? paths[0])?.points_mm ?? null;

/** Index of the last time that is not after `time`; −1 before the first. */
export function indexAt(times, time) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Where the robot has been up to a time, [[x, y]] in mm, as far back as the trail goes. */
export function trailTo({ series }, time, pose) {
  const points = pose ? [[pose.x_mm, pose.y_mm]] : [];
  let length = 0;
  for (let index = indexAt(series.time_s, time); index >= 0 && length < TRAIL_MM; index -= 1) {
    const point = [series.x_mm[index], series.y_mm[index]];
    if (point[0] === null || point[1] === null) continue;
    const last = points.at(-1);
    if (last) length += Math.hypot(point[0] - last[0], point[1] - last[1]);
    points.push(point);
  }
  return points.reverse();
}
