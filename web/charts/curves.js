/** What the charts show. */

const COILS = [["x", "first"], ["y", "second"], ["z", "third"]];

/**
 * column: of the telemetry (live/ticks.js); group: curves that are hidden together, by the first one's column;
 * only those with a label are in the legend.
 *
 * @typedef {{column: string, group: string, label?: string, unit: string, colour: string, style?: "dots" | "dashes",
 *           fromZero?: boolean}} Curve
 * @type {{title: string, note: string, empty?: string, liveOnly?: boolean, curves: Curve[]}[]}
 */
export const CHARTS = [
  {
    title: "Error", note: "centre to target", empty: "Shown once a run is on.",
    curves: [{ column: "error_mm", group: "error_mm", label: "error", unit: "mm", colour: "first", fromZero: true }],
  },
  {
    title: "Pose", note: "line estimate · dots measured · dashes reference",
    curves: [
      ...tripled("x", "x", "mm", "first"),
      ...tripled("y", "y", "mm", "second"),
      { column: "heading_deg", group: "heading_deg", label: "heading", unit: "deg", colour: "third" },
      { column: "heading_measured_deg", group: "heading_deg", unit: "deg", colour: "third", style: "dots" },
      { column: "heading_goal_deg", group: "heading_deg", unit: "deg", colour: "third", style: "dashes" },
    ],
  },
  {
    title: "Currents", note: "line commanded · dots measured",
    curves: COILS.flatMap(/** @returns {Curve[]} */ ([axis, colour]) => [
      { column: `current_${axis}_A`, group: `current_${axis}_A`, label: axis, unit: "A", colour },
      { column: `measured_${axis}_A`, group: `current_${axis}_A`, unit: "A", colour, style: "dots" },
    ]),
  },
  {
    title: "Latency", note: "picture: its age · loop, period: 99th percentile", liveOnly: true,
    curves: [
      { column: "picture_age_ms", label: "picture", colour: "first" },
      { column: "loop_latency_ms", label: "loop", colour: "second" },
      { column: "loop_period_ms", label: "period", colour: "third" },
    ].map((curve) => ({ ...curve, group: curve.column, unit: "ms", fromZero: true })),
  },
];

/** @returns {Curve[]} */
function tripled(name, label, unit, colour) {
  const group = `${name}_mm`;
  return [
    { column: group, group, label, unit, colour },
    { column: `${name}_measured_mm`, group, unit, colour, style: "dots" },
    { column: `${name}_reference_mm`, group, unit, colour, style: "dashes" },
  ];
}
