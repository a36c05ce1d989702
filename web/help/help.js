/** From a parameter to its help: words, symbol, equation and figure. Loaded when somebody asks for the first time. */
import { CONTROLLERS } from "./controllers.js";
import * as control from "./figures/control.js";
import * as field from "./figures/field.js";
import * as paths from "./figures/paths.js";
import * as reference from "./figures/reference.js";
import * as walking from "./figures/walking.js";
import { GAIT, RUN } from "./gait.js";
import { METRICS } from "./metrics.js";
import { FIGURES, VALUES } from "./trajectories.js";

const DRAWN = { ...control, ...field, ...paths, ...reference, ...walking };

/** @param {string[]} of @param {string} name @returns {import("./gait.js").Entry | undefined} */
function entryOf([part, choice], name) {
  if (part === "gait") return GAIT[name];
  if (part === "run") return RUN[name];
  if (part === "metrics") return METRICS[name];
  if (part === "controller") return CONTROLLERS[choice]?.[name];
  return part === "trajectory" && VALUES[name] ? { words: [VALUES[name]], figure: FIGURES[choice] } : undefined;
}

/**
 * @param {string} of whose parameter: "gait", "controller.geometric", "trajectory.eight", "run", "metrics"
 * @param {string} name of the parameter
 * @returns {{words: string[], symbol?: string, equation?: string, Figure: any} | null}
 */
export function helpFor(of, name) {
  const entry = entryOf(of.split("."), name);
  return entry ? { ...entry, Figure: entry.figure ? DRAWN[entry.figure] ?? null : null } : null;
}
