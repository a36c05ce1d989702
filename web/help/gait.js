/** What the values of the gait mean, in the paper's symbols. figure: by its name in figures.js. Pure. */

/** @typedef {{symbol?: string, words: string[], equation?: string, figure?: string}} Entry */

/** @type {Record<string, Entry>} */
export const GAIT = {
  sweep_deg: {
    symbol: "θ_s", figure: "Sweep", equation: "way of one sweep = L sin(θ_s / 2)",
    words: ["The robot stands on one end, its pivot, and swings the other end by this angle. Then the other end becomes the pivot.",
      "Small sweeps follow a path closely and take many steps; large ones take few. The paper walks best at 30 to 35°."],
  },
  tilt_deg: {
    symbol: "α", figure: "Tilt", equation: "B = |B| (cos α cos φ, cos α sin φ, −σ sin α)",
    words: ["The field points out of the plate by this angle. It presses the end that the robot stands on down, and lifts the other.",
      "Too little and the robot sticks, too much and its pivot slips, which costs more. The paper's smallest error is near 24.5°."],
  },
  field_mT: {
    symbol: "|B|", figure: "Field", equation: "τ = M × B",
    words: ["How strong the field is at the robot. It turns the magnet in the robot, whose moment is M, into its own direction.",
      "The currents follow from it and from where the robot is. Where one of them would be too large, all are made smaller alike, so that the direction stays."],
  },
  max_rate_deg_s: {
    symbol: "ω_max", figure: "Rate", equation: "|ω| ≤ ω_max",
    words: ["The fastest that the robot is swung, whatever the controller asks for. Faster follows better until the body cannot keep up with the field."],
  },
  path_step_s: {
    symbol: "Δt", figure: "PathStep", equation: "speed of the reference = Δt / 0.1 s × the path's own speed",
    words: ["How much of the path's own time passes in each 0.1 s. At 0.1 s the path is walked at its own speed, at 0.2 s twice as fast.",
      "The larger it is, the more the reference runs away from the robot, and the larger is the mean error."],
  },
  time_law: {
    figure: "TimeLaws",
    words: ["How the reference moves along the path. By the path step: as the paper does it. Constant speed: the same everywhere. Trapezoidal: from rest to rest. Wait: no farther ahead than the robot follows."],
  },
  speed_mm_s: {
    symbol: "v", figure: "Trapezoid",
    words: ["How fast the reference moves along the path. Used by every time law but the path step. One robot length, 10 mm, in three seconds is a calm walk."],
  },
  acceleration_mm_s2: {
    symbol: "a", figure: "Trapezoid", equation: "v = a t, until v is reached",
    words: ["How soon the reference gathers its speed at the start and loses it at the end, by the trapezoidal time law."],
  },
  wait_mm: {
    figure: "Waiting",
    words: ["By the time law wait, the reference stands still as soon as it is this far ahead of the robot along the path, and goes on when the robot has come nearer."],
  },
  approach: {
    figure: "Approach",
    words: ["The robot first walks straight from where it stands to the start of the path. The errors count from there."],
  },
};

/** @type {Record<string, Entry>} */
export const RUN = {
  passes: { figure: "Passes", words: ["How often the whole path is walked before the run ends. Parts count as well: 0.5 is half of it."] },
};
