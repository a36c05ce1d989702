/** Numbers of a calibration as words that a person can act on. Pure. */
import { quantity } from "../units.js";

/** Largest residual of a lens that is good, and that will do, px. Practice with printed boards: below 0.3 px the
    paper's flatness decides, above 1 px something was wrong with the views. */
const LENS_PX = [0.3, 1];
/** The same of a plane, mm: a hundredth and a thirtieth of a robot's length. */
const PLANE_MM = [0.1, 0.33];
/** Smallest separation of robot and background that is good, and that will do. */
const SEPARATION = [0.5, 0.2];

const WORDS = ["good", "fair", "poor"];

/**
 * @param {unknown} value
 * @param {number[]} limits of what is good, and of what will do
 */
function upTo(value, [good, fair]) {
  if (typeof value !== "number" || !Number.isFinite(value)) return "";
  return WORDS[value <= good ? 0 : value <= fair ? 1 : 2];
}

/** Smaller errors are of no use to anybody, mm. */
const SMALLEST_MM = 0.01;

export const residualWords = ({ residual_mm: residual }) =>
  residual < SMALLEST_MM ? `below ${quantity(SMALLEST_MM, "mm", 2)}` : quantity(residual, "mm", 2);

export const lensGrade = ({ residual_px: residual }) => upTo(residual, LENS_PX);

export const planeGrade = ({ residual_mm: residual }) => upTo(residual, PLANE_MM);

/** 1: nothing else in the picture comes near the robot's colour; 0: it cannot be told from the background. */
export const separationGrade = (separation) => upTo(-separation, SEPARATION.map((least) => -least));

/** "2026-11-23" as the reader writes dates; "" for what is none. */
export function dateWords(text) {
  const date = new Date(text ?? "");
  return Number.isNaN(date.getTime()) ? "" : date.toLocaleDateString([], { year: "numeric", month: "short", day: "numeric" });
}
