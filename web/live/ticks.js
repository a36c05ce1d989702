/**
 * The newest telemetry at full rate, for canvases and charts, with the history they draw.
 * Nothing here triggers a redraw of the page; text reads the store, which is fed more slowly.
 */
import { wrapDegrees } from "../units.js";

export const WINDOW_S = 60;
const TRAIL_STEP_MM = 0.3;
/** A robot that was put elsewhere starts a new trail, mm. */
const TRAIL_JUMP_MM = 15;
const TRAIL_LENGTH = 900;
/** Ticks further apart than this are two stories: the line between them is not drawn, s. */
const GAP_S = 1;

export const COLUMNS = [
  "time_s", "error_mm",
  "x_mm", "x_measured_mm", "x_reference_mm",
  "y_mm", "y_measured_mm", "y_reference_mm",
  "heading_deg", "heading_measured_deg", "heading_goal_deg",
  "current_x_A", "current_y_A", "current_z_A",
  "measured_x_A", "measured_y_A", "measured_z_A",
];

export const live = {
  tick: null,
  /** performance.now() when the newest tick came, ms. */
  receivedAt: 0,
  /** column name -> values, one a tick, over the last WINDOW_S. */
  history: emptyHistory(),
  /** [x_mm, y_mm] where the robot has been. */
  trail: [],
};

const listeners = new Set();

export function onTick(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function publish(tick) {
  live.tick = tick;
  live.receivedAt = performance.now();
  remember(tick);
  extendTrail(tick.pose);
  for (const listener of listeners) listener(tick);
}

export function clearTrail() {
  live.trail = [];
}

function emptyHistory() {
  return Object.fromEntries(COLUMNS.map((name) => [name, []]));
}

function remember(tick) {
  const times = live.history.time_s;
  const before = times.at(-1);
  if (before !== undefined && tick.time_s <= before) live.history = emptyHistory();
  else if (before !== undefined && tick.time_s - before > GAP_S) append({ time_s: before + GAP_S / 2 });
  append(row(tick));
  forget(tick.time_s - WINDOW_S);
}

function append(values) {
  for (const name of COLUMNS) live.history[name].push(values[name] ?? null);
}

/** Drops what left the window, a hundred rows at a time: shifting arrays at every tick would be waste. */
function forget(before) {
  const times = live.history.time_s;
  if (times.length < 200 || times[100] > before) return;
  for (const name of COLUMNS) live.history[name].splice(0, 100);
}

function row(tick) {
  const { pose, measurement, reference, currents_A: asked, measured_currents_A: sensed } = tick;
  const heading = near(pose?.heading_deg, live.history.heading_deg.at(-1) ?? null);
  return {
    time_s: tick.time_s, error_mm: tick.error_mm,
    x_mm: pose?.x_mm, x_measured_mm: measurement?.x_mm, x_reference_mm: reference?.x_mm,
    y_mm: pose?.y_mm, y_measured_mm: measurement?.y_mm, y_reference_mm: reference?.y_mm,
    heading_deg: heading,
    heading_measured_deg: near(measurement?.heading_deg, heading),
    heading_goal_deg: tick.command?.field_mT > 0 ? near(tick.command.heading_goal_deg, heading) : null,
    current_x_A: asked?.[0], current_y_A: asked?.[1], current_z_A: asked?.[2],
    measured_x_A: sensed?.[0], measured_y_A: sensed?.[1], measured_z_A: sensed?.[2],
  };
}

/** The same angle on the turn nearest to `heading`, so that two curves of one angle stay together. */
export function near(angle, heading) {
  if (typeof angle !== "number") return null;
  return heading === null ? wrapDegrees(angle) : heading + wrapDegrees(angle - heading);
}

function extendTrail(pose) {
  if (!pose) return;
  const last = live.trail.at(-1);
  const step = last ? Math.hypot(pose.x_mm - last[0], pose.y_mm - last[1]) : Infinity;
  if (step < TRAIL_STEP_MM) return;
  if (step > TRAIL_JUMP_MM) live.trail = [];
  live.trail.push([pose.x_mm, pose.y_mm]);
  if (live.trail.length > TRAIL_LENGTH) live.trail.splice(0, live.trail.length - TRAIL_LENGTH);
}
