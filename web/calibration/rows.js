/** Everything that can be calibrated, as rows of an overview: how it stands, what was found, when, and the way to it. Pure. */
import { quantity } from "../units.js";
import { numbersOf } from "./figures.js";
import { lensGrade, planeGrade, residualWords } from "./grades.js";

/**
 * @typedef {{name: string, title: string, about: string, standing: "done" | "open" | "wrong", found: string, grade?: string,
 *   date: string, why: string, step?: string, command?: string}} Row
 *   date: ISO, "" for none; why: what is wrong, or what holds instead; step: of the wizard; command: where it needs hands
 */

const NOT_MEASURED = "not measured";

/**
 * @param {{calibration: any, vision: any, star: any, latency: any, rig: any, tracking: string}} known answers, or null
 * @returns {Row[]}
 */
export function rowsOf({ calibration, vision, star, latency, rig, tracking }) {
  return [
    colour(vision, tracking), lens(calibration), plane(calibration), delay(latency), robot(star),
    place(rig), field(rig), sense(rig),
  ].filter((row) => row !== null);
}

/** @returns {Row | null} */
function colour(vision, tracking) {
  if (!vision) return null;
  const [from, to] = vision.colour.hue_deg;
  const lost = tracking === "lost";
  return {
    name: "colour", title: "Colour", about: "which colour is the robot, in this light", step: "colour", date: "",
    standing: lost ? "wrong" : "done", why: lost ? "The robot is not seen just now." : "",
    found: `lighting ${vision.profile}, hue ${Math.round(from)}° to ${Math.round(to)}°`,
  };
}

/** @returns {Row | null} */
function lens(calibration) {
  if (!calibration) return null;
  const found = calibration.lens;
  return {
    name: "lens", title: "Lens", about: "how it bends straight lines", step: "lens", date: found?.date ?? "",
    ...fit(found, "As the rig file assumes."), grade: found ? lensGrade(found) : "",
    found: found ? `residual ${quantity(found.residual_px, "px", 2)}, ${found.views} views` : "",
  };
}

const PLANE_SOURCES = { board: "the printed board", corners: "four corners", marks: "marks" };

/** @returns {Row | null} */
function plane(calibration) {
  if (!calibration) return null;
  const found = calibration.plane;
  return {
    name: "plane", title: "Plane", about: "where the camera hangs over the plate", step: "plane", date: found?.date ?? "",
    ...fit(found, "As the rig file assumes: straight above the plate."), grade: found ? planeGrade(found) : "",
    found: found ? `residual ${residualWords(found)}, from ${PLANE_SOURCES[found.source] ?? found.source}` : "",
  };
}

const fit = (found, otherwise) => {
  if (!found) return { standing: /** @type {const} */ ("open"), why: otherwise };
  return found.fits ? { standing: /** @type {const} */ ("done"), why: "" } : { standing: /** @type {const} */ ("wrong"), why: `Not used: ${found.why_not}` };
};

/** @returns {Row | null} */
function delay(latency) {
  if (!latency) return null;
  const { in_use: used } = latency;
  return {
    name: "latency", title: "Camera delay", about: "how late its pictures come", step: "robot",
    ...source(used.source, "Not measured on this rig."), found: quantity(used.latency_ms, "ms"),
  };
}

/** @returns {Row | null} */
function robot(star) {
  if (!star) return null;
  const used = star.in_use;
  const found = numbersOf("star", used).map(([title, text]) => `${title.toLowerCase()} ${text}`).join(", ");
  return {
    name: "star", title: "Pivot length, heading", about: "how the robot is built, from a walked star", step: "robot",
    ...source(used.source, "Not measured: as the rig file assumes."), found,
  };
}

/** @returns {Row | null} */
function place(rig) {
  const found = rig?.coils?.registration;
  if (!found) return null;
  const known = found.x_mm !== 0 || found.y_mm !== 0 || found.rotation_deg !== 0 || found.magnet_reversed;
  return {
    name: "registration", title: "Place of the coils", about: "where they stand in the workspace", date: "",
    command: "pivotrig calibrate registration", standing: known ? "done" : "open",
    why: known ? "" : "As assumed: centred on the workspace.",
    found: known ? `${quantity(found.x_mm, "mm")}, ${quantity(found.y_mm, "mm")}, turned by ${quantity(found.rotation_deg, "deg")}${found.magnet_reversed ? ", magnet reversed" : ""}` : "",
  };
}

/** @returns {Row | null} */
function field(rig) {
  const coils = rig?.coils;
  if (!coils) return null;
  const gains = ["x", "y", "z"].map((axis) => coils[axis]?.field_gain);
  return {
    name: "coils", title: "Field of the coils", about: "field per ampere, with a magnetometer", command: "pivotrig calibrate coils",
    ...source(coils.field_source === "geometry" ? NOT_MEASURED : coils.field_source, "From the coils’ geometry."),
    found: `gains ${gains.map((gain) => quantity(gain, "", 2).trim()).join(", ")}`,
  };
}

/** What the driver's data sheet says, mA per count of the board's converter. */
const NOMINAL_SENSE = 34.88;

/** @returns {Row | null} */
function sense(rig) {
  const coils = rig?.coils;
  if (!coils) return null;
  const known = ["x", "y", "z"].some((axis) => coils[axis]?.sense_mA_per_count.some((value) => value !== NOMINAL_SENSE));
  return {
    name: "sense", title: "Current sense", about: "measured current, with an ammeter", command: "pivotrig calibrate sense", date: "",
    standing: known ? "done" : "open", found: "", why: known ? "" : "As the driver’s data sheet says, up to 25 % off.",
  };
}

/** Of figures whose source is said in words: "measured 2026-11-23, …". */
function source(words, otherwise) {
  if (!words || words === NOT_MEASURED) return { standing: /** @type {const} */ ("open"), date: "", why: otherwise };
  return { standing: /** @type {const} */ ("done"), date: /\d{4}-\d{2}-\d{2}/.exec(words)?.[0] ?? "", why: words.replace(/^measured \d{4}-\d{2}-\d{2},?\s*/, "") };
}

const DAY_MS = 86_400_000;

/** "today", "yesterday", "12 days ago"; "" for no date. */
export function dayAge(date, now = new Date()) {
  const then = new Date(date);
  if (Number.isNaN(then.getTime())) return "";
  const days = Math.round((startOf(now) - startOf(then)) / DAY_MS);
  return days <= 0 ? "today" : days === 1 ? "yesterday" : `${days} days ago`;
}

const startOf = (time) => new Date(time.getFullYear(), time.getMonth(), time.getDate()).getTime();

