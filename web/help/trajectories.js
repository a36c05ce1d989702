/** What the values of the paths mean. Pure. */

/** @typedef {import("./gait.js").Entry} Entry */

/** The figure of each path, by its name. */
export const FIGURES = {
  circle: "Circle", eight: "Eight", letter: "Letter", line: "StraightLine", lissajous: "Lissajous", polygon: "Polygon", spiral: "Spiral", waypoints: "Waypoints",
};

const PLATE = "Counted from the middle of the plate, where the coils' axes meet.";
const SPEED = "The path's own speed: how fast the reference moves at a path step of 0.1 s.";
const PERIOD = "How long the whole figure takes at a path step of 0.1 s. The paper's eight takes 125.7 s.";

/** What a value means wherever it occurs. @type {Record<string, string>} */
export const VALUES = {
  radius_mm: "From the centre to the path; of a polygon, to a corner before it is rounded.",
  centre_x_mm: `Where the middle of the path lies along x. ${PLATE}`,
  centre_y_mm: `Where the middle of the path lies along y. ${PLATE}`,
  speed_mm_s: SPEED,
  direction: "The way round that is walked, seen from above.",
  width_mm: "How wide the path is along x, from its leftmost to its rightmost point.",
  height_mm: "How high the path is along y, from its lowest to its highest point.",
  period_s: PERIOD,
  letter: "Which letter is walked, in one smooth stroke.",
  start_x_mm: `Where the line begins, along x. ${PLATE}`,
  start_y_mm: `Where the line begins, along y. ${PLATE}`,
  end_x_mm: `Where the line ends, along x. ${PLATE}`,
  end_y_mm: `Where the line ends, along y. ${PLATE}`,
  frequency_x: "How many waves there are along x in one whole figure.",
  frequency_y: "How many waves there are along y in one whole figure.",
  phase_deg: "Where the wave along x begins when the one along y begins at zero. 90° gives the widest figure.",
  corners: "How many corners the polygon has.",
  corner_radius_mm: "How round the corners are. 0 is a sharp corner, which the robot cuts or overshoots.",
  rotation_deg: "How far the polygon is turned to the left. At 0 the first corner is straight below the centre.",
  inner_radius_mm: "Where the spiral is tightest.",
  outer_radius_mm: "Where the spiral is widest; it has to lie inside the workspace.",
  turns: "How often it goes round.",
  way: "From the centre outwards, or inwards to the centre.",
  points_mm: "One point a line, x and y in mm from the middle of the plate, in the order of the walk. They can be drawn in the camera picture as well.",
  closed: "After the last point the path returns to the first.",
  kind: "Straight pieces from point to point, or a smooth curve through them.",
};
