/** What the parameters of the controllers mean; by controller and parameter, or by parameter alone. Pure. */

/** @typedef {import("./gait.js").Entry} Entry */

const COST = "J = ½ |c − x_d|² + ½ w L² (θ − θ_d)²";

/** @type {Record<string, Entry>} */
const HEADINGS = {
  heading: {
    symbol: "θ_d", figure: "HeadingError",
    words: ["Whether the direction of walking matters too. Free: the place alone counts. Along or across: as the path runs. Fixed: the angle that is given."],
  },
  heading_deg: {
    symbol: "θ_d", figure: "Heading",
    words: ["The wanted direction of walking, counted from the x axis to the left. The robot's long axis lies square to it."],
  },
  heading_weight: {
    symbol: "w", figure: "Weights", equation: COST,
    words: ["How much a wrong heading counts beside a wrong place. At 1, one radian (57°) counts like one robot length."],
  },
};

/** @type {Record<string, Entry>} */
const RATE = {
  rate_deg_s: { symbol: "ω", figure: "Rate", words: ["How fast the robot swings about its pivot. The gait's fastest swing is the limit."] },
};

/** @type {Record<string, Record<string, Entry>>} */
export const CONTROLLERS = {
  geometric: {
    gain: {
      symbol: "k", figure: "Gain", equation: "ω = k σ e_n,   σ = sign(d_B − d_A)",
      words: ["How fast the robot swings for each centimetre to the reference. It stands on the end that is nearer to the reference.",
        "Too small and it falls behind; too large and it rocks about the path. Around 7 is best for sweeps of 10°, around 3 for 30°."],
    },
  },
  gradient: {
    ...HEADINGS,
    look_ahead_s: {
      symbol: "τ", figure: "LookAhead", equation: "J at the end of the arc that lasts τ",
      words: ["How far ahead the arc is predicted whose end is to be near the reference. Empty: it follows from the sweep, half a second at 10° and one second at 30°.",
        "A look-ahead that ends within the sweep that is under way cannot see past it, and loses the path."],
    },
  },
  planner: {
    ...HEADINGS,
    early_end: { figure: "Sweep", words: ["A sweep may end at a part of its angle where that brings the robot nearer to the path. More accurate, and more steps."] },
    switch_weight: { figure: "Weights", words: ["What each change of the pivot costs, beside the error. At 0 only the error counts; larger values save steps."] },
    sweep_weight: { figure: "Weights", words: ["What each sweep costs, beside the error. Larger values: fewer sweeps and larger errors."] },
    effort_weight: { figure: "Weights", words: ["What turning costs, beside the error, for each radian. Larger values: calmer walks and larger errors."] },
    horizon_slots: { figure: "Plans", words: ["How far ahead plans are made, counted in halves of the fastest sweep. Farther is better around corners and takes longer to work out."] },
    beam_width: { figure: "Plans", words: ["How many plans are kept at each step ahead. More find better walks and take longer to work out."] },
    learn_slip: { figure: "Steps", words: ["What the planner expects of each sweep is corrected by what the camera sees, so that slipping is reckoned with."] },
  },
  hold: {
    heading_deg: HEADINGS.heading_deg,
    gain: { symbol: "k", figure: "HeadingError", equation: "ω = k (θ_d − θ)", words: ["How fast the robot turns for each radian that its heading is off."] },
    tolerance_deg: { figure: "HeadingError", words: ["A heading that is off by less is left alone, so that the robot comes to rest."] },
  },
  sequence: {
    table: { figure: "Steps", words: ["Rows of pivot, turn in degrees and rate in degrees a second, with a semicolon between: “B 15 60; A -30 60”. Turns to the left are positive.", "Nobody looks at the path: good for measuring how the robot walks."] },
    repeat: { figure: "Steps", words: ["After the last row it begins again with the first, until the run ends."] },
  },
  straight: {
    ...RATE,
    distance_mm: { figure: "Steps", equation: "steps = ⌈D / (L sin(θ_s / 2)) + ½⌉", words: ["How far the robot walks along its heading: half a sweep, then whole ones. Nobody looks at the path."] },
    backwards: { figure: "Heading", words: ["Walks against its heading."] },
  },
  star: {
    ...RATE,
    legs: { figure: "Star", words: ["How many straight legs are walked out and back, evenly all round. What they measure is the same in every direction only if the robot is."] },
    leg_mm: { figure: "Star", words: ["How long each leg is. Longer legs measure better and need more of the plate."] },
  },
  to_pose: {
    ...RATE,
    x_mm: { symbol: "x", figure: "Pose", words: ["Where to end, along x, counted from the middle of the plate."] },
    y_mm: { symbol: "y", figure: "Pose", words: ["Where to end, along y, counted from the middle of the plate."] },
    heading_deg: { symbol: "θ", figure: "Pose", words: ["The direction of walking at the end."] },
    within_mm: { figure: "Pose", words: ["As near as this to the place is there."] },
    within_deg: { figure: "HeadingError", words: ["As near as this to the heading is there."] },
  },
  wiggle: {
    ...RATE,
    turns: { figure: "Wiggle", words: ["How many turns are made; to and fro are two. More measure the delay of camera and field better."] },
    turn_deg: { figure: "Wiggle", words: ["How far each turn goes from one end to the other."] },
  },
};
