/** How the reference, the point that the robot follows, moves along the path. */
import { html } from "../../view.js";
import { polyline, sampled } from "./geometry.js";
import { Arrow, Dot, Figure, Length, Letters, Line, Robot } from "./parts.js";

const wave = (share) => /** @type {[number, number]} */ ([20 + 200 * share, 84 - 40 * Math.sin(Math.PI * 1.5 * share)]);
const PATH = polyline(sampled(wave));

export const PathStep = () => html`
  <${Figure} title="The reference on the path at each tenth of a second: a larger path step puts the places further apart.">
    <${Line} tone="soft" d=${PATH} />
    ${Array.from({ length: 9 }, (_, index) => html`<${Dot} at=${wave(0.1 + index * 0.1)} tone=${index === 4 ? "accent" : "second"} />`)}
    <${Letters} at=${[wave(0.5)[0], wave(0.5)[1] - 12]} text="x_d" tone="accent" />
    <${Length} from=${[wave(0.2)[0], 26]} to=${[wave(0.3)[0], 26]} /><${Letters} at=${[wave(0.25)[0], 18]} text="Δt" tone="accent" />
    <${Letters} at=${[120, 134]} text="one point each 0.1 s" tone="soft" />
  <//>`;

const PANEL = 112;
/** [title, speed over time as shares of the panel] */
const LAWS = [
  ["path step", "M0 26C18 4 30 44 50 22S82 30 96 14"],
  ["constant speed", "M0 22H96"],
  ["trapezoidal", "M0 44L22 14H74L96 44"],
  ["wait", "M0 18H34V44H58V18H96"],
];

export const TimeLaws = () => html`
  <${Figure} title="The reference's speed over time, by each of the four time laws." height=${156}>
    ${LAWS.map(([title, d], index) => html`
      <g transform=${`translate(${10 + (index % 2) * (PANEL + 6)} ${8 + Math.floor(index / 2) * 76})`}>
        <${Line} tone="soft" d="M0 48V0M0 48H102" /><${Line} tone="accent" d=${d} /><${Letters} at=${[50, 64]} text=${title} tone="soft" />
      </g>`)}
  <//>`;

export const Trapezoid = () => html`
  <${Figure} title="The reference's speed over time: it gathers speed, keeps it, and comes to rest at the end.">
    <${Line} tone="soft" d="M26 112V16M26 112H228" /><${Line} tone="accent" d="M26 112L76 38H168L218 112" /><${Line} dashed tone="soft" d="M26 38H76" />
    <${Letters} at=${[17, 42]} text="v" tone="accent" /><${Letters} at=${[64, 84]} text="a" tone="second" anchor="start" /><${Line} tone="second" d="M45 84H60V62" />
    <${Letters} at=${[222, 128]} text="time" tone="soft" anchor="end" />
  <//>`;

export const Waiting = () => html`
  <${Figure} title="The reference waits as soon as it is this far ahead of the robot.">
    <${Line} tone="soft" d=${PATH} /><${Robot} centre=${wave(0.25)} angle=${70} />
    <${Dot} at=${wave(0.72)} tone="accent" size=${5} /><${Letters} at=${[wave(0.72)[0] + 16, wave(0.72)[1] + 4]} text="x_d" tone="accent" anchor="start" />
    <${Line} tone="second" dashed d=${polyline(sampled((share) => wave(0.25 + 0.47 * share)))} />
    <${Letters} at=${[130, 40]} text="at most this far" tone="second" anchor="start" />
  <//>`;

export const Approach = () => html`
  <${Figure} title="The robot first walks straight to the start of the path.">
    <${Line} tone="soft" d=${polyline(sampled((share) => [100 + 120 * share, 60 - 34 * Math.sin(Math.PI * 1.6 * share)]))} />
    <${Robot} centre=${[36, 104]} angle=${120} /><${Arrow} from=${[50, 98]} to=${[94, 65]} tone="accent" /><${Dot} at=${[100, 60]} tone="second" size=${5} />
    <${Letters} at=${[100, 82]} text="start" tone="second" anchor="start" />
  <//>`;

export const Passes = () => html`
  <${Figure} title="The path, walked again and again from its start.">
    <${Line} tone="accent" d=${polyline(sampled((share) => [120 + 70 * Math.sin(4 * Math.PI * share), 62 + 50 * Math.cos(2 * Math.PI * share)], 120))} />
    <${Dot} at=${[120, 112]} tone="second" size=${5} /><${Letters} at=${[120, 133]} text="start" tone="second" />
  <//>`;
