/** What a controller looks at and what it weighs. */
import { html } from "../../view.js";
import { polar, polyline, sampled } from "./geometry.js";
import { Angle, Arrow, Dot, Figure, HALF, Letters, Line, Robot } from "./parts.js";

const CENTRE = /** @type {[number, number]} */ ([78, 76]);
const WANTED = /** @type {[number, number]} */ ([186, 42]);

export const Gain = () => html`
  <${Figure} title="The robot from above: it stands on the pivot nearest to the reference and swings in proportion to the distance.">
    <${Robot} centre=${CENTRE} angle=${70} stands="A" /><${Arrow} from=${CENTRE} to=${WANTED} tone="accent" /><${Dot} at=${WANTED} tone="second" size=${5} />
    <${Letters} at=${[200, 40]} text="x_d" tone="second" anchor="start" /><${Letters} at=${[152, 80]} text="e_n" tone="accent" />
    <${Line} dashed tone="soft" d=${polyline([polar(CENTRE, HALF, 70), WANTED]) + polyline([polar(CENTRE, HALF, 250), WANTED])} />
    <${Letters} at=${[128, 38]} text="d_A" tone="soft" /><${Letters} at=${[112, 102]} text="d_B" tone="soft" />
    <${Angle} at=${polar(CENTRE, HALF, 70)} radius=${62} from=${-112} to=${-78} tone="accent" /><${Letters} at=${[82, 130]} text="ω = k σ e_n" tone="accent" />
  <//>`;

/** Arcs about the end that it stands on. */
const ahead = (turn, pivot = polar(CENTRE, HALF, 70)) => polar(pivot, HALF, 250 + turn);

export const LookAhead = () => html`
  <${Figure} title="The robot from above with the arc that it would walk until the look-ahead time has passed.">
    <${Robot} centre=${CENTRE} angle=${70} stands="A" /><${Robot} centre=${ahead(64)} angle=${134} ghost />
    <${Line} tone="accent" d=${polyline(sampled((share) => ahead(64 * share)))} /><${Dot} at=${ahead(64)} tone="accent" />
    <${Dot} at=${[158, 96]} tone="second" size=${5} /><${Letters} at=${[168, 100]} text="x_d in τ" tone="second" anchor="start" />
    <${Line} dashed tone="soft" d=${polyline([ahead(64), [158, 96]])} /><${Letters} at=${[134, 122]} text="τ ahead" tone="accent" />
  <//>`;

export const HeadingError = () => html`
  <${Figure} title="The robot from above: its heading, the wanted heading, and the angle between them.">
    <${Robot} centre=${[92, 92]} angle=${110} /><${Arrow} from=${[92, 92]} to=${polar([92, 92], 82, 20)} /><${Arrow} from=${[92, 92]} to=${polar([92, 92], 82, 62)} tone="second" />
    <${Angle} at=${[92, 92]} radius=${58} from=${20} to=${62} tone="accent" /><${Letters} at=${[182, 66]} text="θ" /><${Letters} at=${[142, 18]} text="θ_d" tone="second" anchor="start" />
    <${Letters} at=${[154, 50]} text="θ_d − θ" tone="accent" anchor="start" />
  <//>`;

export const Weights = () => html`
  <${Figure} title="What is weighed: the distance to the reference against the angle to the wanted heading.">
    <${Line} tone="soft" d="M120 36V108M96 116H144L120 104Z" /><${Line} d="M52 48L188 30" /><${Line} tone="soft" d="M52 48L34 84H70ZM188 30L170 66H206Z" />
    <${Dot} at=${[120, 38]} tone="soft" /><${Letters} at=${[52, 80]} text="e²" tone="accent" /><${Letters} at=${[188, 61]} text="w" tone="second" />
    <${Letters} at=${[52, 104]} text="error" tone="accent" /><${Letters} at=${[188, 86]} text="cost" tone="second" />
  <//>`;

const NODES = /** @type {[number, number][]} */ ([[24, 72], [84, 40], [84, 104], [146, 22], [146, 58], [146, 92], [146, 122], [212, 40], [212, 74]]);
const TWIGS = [[0, 1], [0, 2], [1, 3], [1, 4], [2, 5], [2, 6], [4, 7], [4, 8]];
const BEST = [[0, 1], [1, 4], [4, 8]];

/** A tree of plans: several are kept at each step, the best one is begun. */
export const Plans = () => html`
  <${Figure} title="A tree of plans: at each step the best few are kept, and the best of all is begun.">
    ${TWIGS.map(([from, to]) => html`<${Line} tone="soft" d=${polyline([NODES[from], NODES[to]])} />`)}
    ${BEST.map(([from, to]) => html`<${Line} tone="accent" d=${polyline([NODES[from], NODES[to]])} />`)}
    ${NODES.map((at, index) => html`<${Dot} at=${at} tone=${[0, 1, 4, 8].includes(index) ? "accent" : "soft"} />`)}
    <${Letters} at=${[118, 138]} text="horizon →" tone="soft" /><${Letters} at=${[170, 112]} text="kept" tone="soft" anchor="start" />
  <//>`;

/** The centre beside the reference: what every figure of merit is made from. */
export const Distance = () => html`
  <${Figure} title="The path, the reference on it, and the distance from the robot's centre to it.">
    <${Line} tone="soft" d=${polyline(sampled((share) => [16 + 208 * share, 52 - 26 * Math.sin(Math.PI * 1.4 * share)]))} />
    <${Robot} centre=${[92, 92]} angle=${100} /><${Dot} at=${[132, 28]} tone="second" size=${5} /><${Line} tone="accent" d="M92 92L132 28" /><${Dot} at=${[92, 92]} tone="accent" />
    <${Letters} at=${[124, 70]} text="e" tone="accent" /><${Letters} at=${[144, 20]} text="x_d" tone="second" anchor="start" /><${Letters} at=${[76, 98]} text="C" anchor="end" />
  <//>`;

/** The error over a run, with its mean and its largest. */
export const ErrorOverTime = () => html`
  <${Figure} title="The error over the time of a run, with its mean and its largest value.">
    <${Line} tone="soft" d="M26 112V16M26 112H228" /><${Line} d=${polyline(sampled((share) => [26 + 196 * share, 84 - 30 * Math.sin(9 * share) ** 2 * (0.4 + share) - 6 * Math.cos(40 * share)], 90))} />
    <${Line} dashed tone="accent" d="M26 72H228" /><${Letters} at=${[222, 66]} text="mean" tone="accent" anchor="end" /><${Letters} at=${[16, 24]} text="e" /><${Letters} at=${[222, 128]} text="time" tone="soft" anchor="end" />
  <//>`;
