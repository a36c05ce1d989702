/** How the robot swings about its pivots, seen from above. */
import { html } from "../../view.js";
import { polar, polyline, sampled } from "./geometry.js";
import { Angle, Arrow, Dot, Figure, HALF, Length, Letters, Line, Robot } from "./parts.js";

const PIVOT = /** @type {[number, number]} */ ([80, 44]);

/** The centre of a robot that stands on A there and lies along `angle` from B to A. */
const about = (angle, pivot = PIVOT) => polar(pivot, HALF, angle + 180);

export const Sweep = () => html`
  <${Figure} title="The robot from above, standing on pivot A: its other end has swung by the sweep.">
    <${Line} dashed tone="soft" d=${polyline([PIVOT, polar(PIVOT, 96, -125)])} /><${Line} dashed tone="soft" d=${polyline([PIVOT, polar(PIVOT, 96, -60)])} />
    <${Robot} centre=${about(55)} angle=${55} ghost /><${Robot} centre=${about(120)} angle=${120} stands="A" />
    <${Angle} at=${PIVOT} radius=${80} from=${-125} to=${-60} tone="accent" />
    <${Letters} at=${[84, 116]} text="θ_s" tone="accent" /><${Letters} at=${[66, 36]} text="A" /><${Letters} at=${[30, 96]} text="B" anchor="end" />
    <${Robot} centre=${[176, 66]} angle=${90} /><${Arrow} from=${[184, 66]} to=${[218, 66]} tone="second" />
    <${Letters} at=${[212, 58]} text="θ" tone="second" /><${Letters} at=${[176, 32]} text="A" /><${Letters} at=${[176, 111]} text="B" />
    <${Length} from=${[154, 40]} to=${[154, 92]} /><${Letters} at=${[144, 70]} text="L" tone="soft" />
  <//>`;

export const Rate = () => html`
  <${Figure} title="The robot from above, swinging about pivot A with the rate omega.">
    <${Robot} centre=${about(55)} angle=${55} ghost /><${Robot} centre=${about(90)} angle=${90} stands="A" /><${Robot} centre=${about(120)} angle=${120} ghost />
    <${Angle} at=${PIVOT} radius=${66} from=${-125} to=${-52} tone="accent" /><${Letters} at=${[80, 130]} text="ω" tone="accent" />
    <${Letters} at=${[80, 32]} text="A" />
    <${Line} tone="soft" d="M150 112H226M150 112V36" /><${Line} tone="soft" dashed d="M150 56H226" />
    <${Line} tone="accent" d="M150 112L188 56H226" /><${Letters} at=${[194, 48]} text="ω_max" tone="accent" /><${Letters} at=${[222, 127]} text="error" tone="soft" anchor="end" />
  <//>`;

/** Half a sweep, then whole ones: the centre goes along arcs around pivots that stand still. */
const STEPS = sampled((share) => [26 + 188 * share, 76 - 13 * Math.abs(Math.sin(4 * Math.PI * share))], 120);

export const Steps = () => html`
  <${Figure} title="A walk from above: arc after arc, on one pivot and then on the other.">
    <${Line} tone="accent" d=${polyline(STEPS)} />
    <${Robot} centre=${[26, 76]} angle=${90} ghost /><${Robot} centre=${[96, 66]} angle=${104} stands="A" /><${Robot} centre=${[214, 76]} angle=${90} stands="B" />
    <${Length} from=${[26, 124]} to=${[214, 124]} /><${Letters} at=${[120, 118]} text="way" tone="soft" />
    <${Letters} at=${[96, 30]} text="A" /><${Letters} at=${[224, 106]} text="B" anchor="start" />
  <//>`;

export const Heading = () => html`
  <${Figure} title="The robot from above: its heading is the direction of walking, square to its long axis.">
    <${Line} tone="soft" dashed d="M100 84H210" /><${Robot} centre=${[100, 84]} angle=${125} />
    <${Arrow} from=${[100, 84]} to=${polar([100, 84], 92, 35)} tone="accent" /><${Angle} at=${[100, 84]} radius=${56} from=${0} to=${35} tone="accent" />
    <${Letters} at=${[168, 72]} text="θ" tone="accent" /><${Letters} at=${[204, 98]} text="x" tone="soft" />
    <${Letters} at=${[76, 58]} text="A" /><${Letters} at=${[128, 122]} text="B" />
  <//>`;

export const Pose = () => html`
  <${Figure} title="The robot ends at a place, with a heading.">
    <${Robot} centre=${[44, 104]} angle=${150} ghost /><${Line} dashed tone="soft" d="M52 98L160 58" />
    <circle class="figure-line" data-tone="soft" data-dashed="true" cx="172" cy="54" r="16" />
    <${Robot} centre=${[172, 54]} angle=${100} /><${Arrow} from=${[172, 54]} to=${polar([172, 54], 52, 10)} tone="accent" />
    <${Dot} at=${[172, 54]} tone="second" /><${Letters} at=${[172, 100]} text="x, y" tone="second" /><${Letters} at=${[226, 36]} text="θ" tone="accent" />
  <//>`;

export const Star = () => html`
  <${Figure} title="A star from above: legs walked out and back in directions all round.">
    ${[90, 162, 234, 306, 18].map((angle) => html`<${Arrow} from=${[120, 72]} to=${polar([120, 72], 56, angle)} tone="accent" />`)}
    <${Dot} at=${[120, 72]} tone="second" /><${Letters} at=${[150, 46]} text="leg" tone="soft" anchor="start" />
  <//>`;

export const Wiggle = () => html`
  <${Figure} title="The robot from above, turning to and fro on one pivot.">
    <${Robot} centre=${[120, 62]} angle=${90} stands="A" /><${Robot} centre=${polar([120, 36], HALF, 250)} angle=${70} ghost /><${Robot} centre=${polar([120, 36], HALF, 290)} angle=${110} ghost />
    <${Angle} at=${[120, 36]} radius=${72} from=${-90} to=${-68} tone="accent" /><${Angle} at=${[120, 36]} radius=${72} from=${-90} to=${-112} tone="accent" />
    <${Letters} at=${[120, 128]} text="turn" tone="accent" /><${Letters} at=${[120, 24]} text="A" />
  <//>`;
