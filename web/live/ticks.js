/**
 * The newest telemetry at full rate, for canvases and charts, with the history they draw.
 * Nothing here triggers a redraw of the page; text reads the store, which is fed more slowly.
 */
import { wrapDegrees } from "../units.js";
import { History } from "./history.js";

/** Of the telemetry stream, ticks a second at most (live/connection.js asks for it). */
const RATE_HZ = 30;
const HISTORY_S = 3600;
const MARKS_KEPT = 400;
const TRAIL_STEP_MM = 0.3;
/** A robot that was put elsewhere starts a new trail, mm. */
const TRAIL_JUMP_MM = 15;
const TRAIL_LENGTH = 900;

/** Every curve of the charts, and the time. */
export const COLUMNS = [
  "time_s", "error_mm",
  "x_mm", "x_measured_mm", "x_reference_mm",
  "y_mm", "y_measured_mm", "y_reference_mm",
  "heading_deg", "heading_measured_deg", "heading_goal_deg",
  "current_x_A", "current_y_A", "current_z_A",
  "measured_x_A", "measured_y_A", "measured_z_A",
  "picture_age_ms", "loop_latency_ms", "loop_period_ms",
];

/** @typedef {{time_s: number, kind: "run" | "warn" | "fault" | "info", words: string}} Mark something that happened */

export const live = {
  /** @type {import("../types").Tick | null} */
  tick: null,
  /** performance.now() when the newest tick came, ms. */
  receivedAt: 0,
  /** What to add to a tick's time for that of the clock on the wall, as seconds since 1970. */
  clock_s: 0,
  history: new History(COLUMNS.slice(1), HISTORY_S, RATE_HZ),
  /** @type {Mark[]} what happened in the time of the history, oldest first */
  marks: [],
  /** @type {[number, number][]} [x_mm, y_mm] where the robot has been. */
  trail: [],
};

/** @type {Set<(tick: import("../types").Tick) => void>} */
const listeners = new Set();

/** @param {(tick: import("../types").Tick) => void} listener @returns {() => void} no longer */
export function onTick(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** @param {import("../types").Tick} tick */
export function publish(tick) {
  if (!(tick.time_s > live.history.newest_s)) beginAnew(tick);
  markRun(live.tick?.run, tick);
  live.tick = tick;
  live.receivedAt = performance.now();
  live.history.append(tick.time_s, row(tick));
  extendTrail(tick.pose);
  for (const listener of listeners) listener(tick);
}

export function clearTrail() {
  live.trail = [];
}

/** Remembers what the rig told; on the charts it is a line at its time. @param {number} time_s @param {Mark["kind"]} kind @param {string} words */
export function mark(time_s, kind, words) {
  live.marks.push({ time_s, kind, words });
  if (live.marks.length > MARKS_KEPT) live.marks.shift();
}

/** The first tick, or that of a server that has started again: its clock has nothing to do with the one before. @param {import("../types").Tick} tick */
function beginAnew(tick) {
  live.history.clear();
  live.marks = [];
  live.clock_s = Date.now() / 1000 - tick.time_s;
  heading = null;
}

/** @param {import("../types").RunProgress | null | undefined} before @param {import("../types").Tick} tick */
function markRun(before, { run, time_s }) {
  if (before?.id === run?.id || live.tick === null) return;
  if (before) mark(time_s, "run", "run ended");
  if (run) mark(time_s, "run", "run began");
}

/** @type {number | null} of the newest tick, on the turn that its curve is on */
let heading = null;

/** @param {import("../types").Tick} tick */
function row(tick) {
  const { pose, measurement, reference, currents_A: asked, measured_currents_A: sensed, loop } = tick;
  heading = near(pose?.heading_deg, heading) ?? heading;
  return {
    error_mm: tick.error_mm,
    x_mm: pose?.x_mm, x_measured_mm: measurement?.x_mm, x_reference_mm: reference?.x_mm,
    y_mm: pose?.y_mm, y_measured_mm: measurement?.y_mm, y_reference_mm: reference?.y_mm,
    heading_deg: pose ? heading : null,
    heading_measured_deg: near(measurement?.heading_deg, heading),
    heading_goal_deg: tick.command?.field_mT > 0 ? near(tick.command.heading_goal_deg, heading) : null,
    current_x_A: asked?.[0], current_y_A: asked?.[1], current_z_A: asked?.[2],
    measured_x_A: sensed?.[0], measured_y_A: sensed?.[1], measured_z_A: sensed?.[2],
    picture_age_ms: typeof tick.captured_s === "number" ? 1000 * (tick.time_s - tick.captured_s) : null,
    loop_latency_ms: loop?.latency_p99_ms, loop_period_ms: loop?.period_p99_ms,
  };
}

/** The same angle on the turn nearest to `heading`, so that two curves of one angle stay together. @param {unknown} angle @param {number | null} heading */
export function near(angle, heading) {
  if (typeof angle !== "number") return null;
  return heading === null ? wrapDegrees(angle) : heading + wrapDegrees(angle - heading);
}

/** @param {import("../types").Pose | null} pose */
function extendTrail(pose) {
  if (!pose) return;
  const last = live.trail.at(-1);
  const step = last ? Math.hypot(pose.x_mm - last[0], pose.y_mm - last[1]) : Infinity;
  if (step < TRAIL_STEP_MM) return;
  if (step > TRAIL_JUMP_MM) live.trail = [];
  live.trail.push([pose.x_mm, pose.y_mm]);
  if (live.trail.length > TRAIL_LENGTH) live.trail.splice(0, live.trail.length - TRAIL_LENGTH);
}
