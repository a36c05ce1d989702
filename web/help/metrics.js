/** What the figures of a run mean. Pure. */

/** @typedef {import("./gait.js").Entry} Entry */

/** @type {Record<string, Entry>} */
export const METRICS = {
  mean_error_mm: { figure: "ErrorOverTime", words: ["The mean, over the whole run, of the distance from the robot's centre to the reference."] },
  normalized_mean_error: {
    symbol: "ME", figure: "Distance", equation: "ME = mean |c − x_d| / L",
    words: ["The mean error in robot lengths, as the paper counts it: 0.2 is a fifth of the robot. It lets robots of different length be compared."],
  },
  rms_error_mm: { figure: "ErrorOverTime", equation: "√(mean e²)", words: ["The root of the mean square of the error. Large errors count more than in the mean."] },
  max_error_mm: { figure: "ErrorOverTime", words: ["The largest distance to the reference at any time of the run."] },
  end_error_mm: { figure: "Distance", words: ["How far the robot was from the end of the path when the run ended."] },
  travelled_mm: { figure: "Steps", equation: "travelled / path = (θ_s / 2) / sin(θ_s / 2)", words: ["The way of the robot's centre. It goes along arcs, so it is longer than the path."] },
  steps: { symbol: "N_s", figure: "Steps", words: ["How often the robot changed from one pivot to the other."] },
  sweeps: { figure: "Sweep", words: ["How many sweeps were completed. Rocking on one pivot is several sweeps without a step."] },
  reversals: { figure: "Rate", words: ["How often the direction of swinging changed."] },
};
