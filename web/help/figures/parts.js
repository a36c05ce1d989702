/** What the figures are made of: the robot seen from above, arrows, arcs with an angle, lengths, points and letters. */
import { html } from "../../view.js";
import { pieces } from "../notation.js";
import { arc, head, polar, polyline } from "./geometry.js";

/** Half the robot's length, in a figure's own units. */
export const HALF = 26;

/** @param {{title: string, children: any, height?: number}} props title: what is to be seen, for those who hear it */
export const Figure = ({ title, children, height = 140 }) => html`
  <svg class="figure" viewBox=${`0 0 240 ${height}`} role="img" aria-label=${title}><title>${title}</title>${children}</svg>
`;

/** Symbols slant, words stand. */
const isWord = (text) => /\p{L}{3}/u.test(text.replaceAll(/_\p{L}+/gu, ""));

/** @param {{at: [number, number], text: string, tone?: string, anchor?: string}} props */
export const Letters = ({ at: [x, y], text, tone = "", anchor = "middle" }) => html`
  <text x=${x} y=${y} class="figure-text" data-tone=${tone} data-word=${isWord(text)} text-anchor=${anchor}>${pieces(text).map((piece, index, all) =>
    html`<tspan font-size=${piece.lowered ? "10" : "14"} dy=${piece.lowered ? 4 : index > 0 && all[index - 1].lowered ? -4 : 0}>${piece.text}</tspan>`)}</text>
`;

/** @param {{d: string, tone?: string, dashed?: boolean}} props */
export const Line = ({ d, tone = "", dashed = false }) => html`<path class="figure-line" data-tone=${tone} data-dashed=${dashed} d=${d} />`;

/** @param {{from: [number, number], to: [number, number], tone?: string}} props */
export const Arrow = ({ from, to, tone = "" }) => html`
  <path class="figure-line" data-tone=${tone} d=${polyline([from, to])} /><path class="figure-solid" data-tone=${tone} d=${head(to, from)} />
`;

/** An angle between two directions, °, with an arrow at its end. */
export function Angle({ at, radius, from, to, tone = "" }) {
  const end = polar(at, radius, to);
  return html`<${Line} d=${arc(at, radius, from, to)} tone=${tone} /><path class="figure-solid" data-tone=${tone} d=${head(end, polar(at, radius, to - Math.sign(to - from) * 14))} />`;
}

/** A length between two points, with a bar at each end. */
export function Length({ from, to, tone = "soft" }) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const size = Math.hypot(dx, dy) || 1;
  const [nx, ny] = [(-dy / size) * 4, (dx / size) * 4];
  const bar = ([x, y]) => polyline([[x - nx, y - ny], [x + nx, y + ny]]);
  return html`<${Line} tone=${tone} d=${polyline([from, to]) + bar(from) + bar(to)} />`;
}

/** @param {{at: [number, number], tone?: string, size?: number}} props */
export const Dot = ({ at: [x, y], tone = "", size = 3.5 }) => html`<circle class="figure-solid" data-tone=${tone} cx=${x} cy=${y} r=${size} />`;

/**
 * The robot from above: a bar with a pivot at each end. angle: of the direction B to A, °; stands: the pivot it stands on.
 * @param {{centre: [number, number], angle: number, ghost?: boolean, stands?: "A" | "B" | ""}} props
 */
export function Robot({ centre, angle, ghost = false, stands = "" }) {
  const [a, b] = [polar(centre, HALF, angle), polar(centre, HALF, angle + 180)];
  return html`
    <g class="figure-robot" data-ghost=${ghost}>
      <path d=${polyline([b, a])} class="figure-body" />
      <circle cx=${a[0]} cy=${a[1]} r="4.5" class="figure-pivot" data-stands=${stands === "A"} />
      <circle cx=${b[0]} cy=${b[1]} r="4.5" class="figure-pivot" data-stands=${stands === "B"} />
    </g>
  `;
}
