/** The paths with what their values measure; one figure a path. */
import { html } from "../../view.js";
import { polar, polyline, sampled } from "./geometry.js";
import { Arrow, Dot, Figure, Length, Letters, Line } from "./parts.js";

const MIDDLE = /** @type {[number, number]} */ ([120, 66]);

const closed = (corners) => `${polyline(corners)}Z`;

export const Eight = () => html`
  <${Figure} title="The figure eight with its width and its height; the walk starts at its lowest point.">
    <${Line} tone="accent" d=${polyline(sampled((share) => [120 - 52 * Math.sin(4 * Math.PI * share), 62 + 46 * Math.cos(2 * Math.PI * share)], 120))} />
    <${Dot} at=${[120, 108]} tone="second" size=${5} />
    <${Length} from=${[68, 128]} to=${[172, 128]} /><${Letters} at=${[180, 132]} text="width" tone="soft" anchor="start" />
    <${Length} from=${[186, 16]} to=${[186, 108]} /><${Letters} at=${[194, 66]} text="height" tone="soft" anchor="start" />
  <//>`;

export const Circle = () => html`
  <${Figure} title="The circle with its centre and its radius; the walk starts at its lowest point.">
    <circle class="figure-line" data-tone="accent" cx="120" cy="66" r="50" /><${Dot} at=${MIDDLE} tone="soft" />
    <${Arrow} from=${MIDDLE} to=${polar(MIDDLE, 50, 35)} tone="soft" /><${Letters} at=${[134, 44]} text="r" tone="soft" />
    <${Dot} at=${[120, 116]} tone="second" size=${5} /><${Letters} at=${[110, 78]} text="x, y" tone="soft" anchor="end" />
    <${Arrow} from=${polar(MIDDLE, 50, 200)} to=${polar(MIDDLE, 50, 178)} tone="accent" />
  <//>`;

export const StraightLine = () => html`
  <${Figure} title="The line from its start to its end.">
    <${Arrow} from=${[50, 108]} to=${[186, 34]} tone="accent" /><${Dot} at=${[50, 108]} tone="second" size=${5} />
    <${Letters} at=${[60, 124]} text="start" tone="second" anchor="start" /><${Letters} at=${[196, 32]} text="end" tone="accent" anchor="start" />
  <//>`;

export const Polygon = () => html`
  <${Figure} title="A polygon with its radius to a corner and its rotation.">
    <${Line} tone="accent" d=${closed([-90, -18, 54, 126, 198].map((angle) => polar([120, 72], 56, angle)))} /><${Dot} at=${[120, 72]} tone="soft" />
    <${Arrow} from=${[120, 72]} to=${polar([120, 72], 54, -18)} tone="soft" /><${Letters} at=${[142, 70]} text="r" tone="soft" />
    <${Dot} at=${polar([120, 72], 56, -90)} tone="second" size=${5} /><${Letters} at=${[134, 132]} text="first corner" tone="second" anchor="start" />
  <//>`;

export const Spiral = () => html`
  <${Figure} title="A spiral between its inner and its outer radius.">
    <${Line} tone="accent" d=${polyline(sampled((share) => polar([112, 70], 10 + 52 * share, 360 * 3 * share), 160))} />
    <${Arrow} from=${[112, 70]} to=${[172, 70]} tone="second" /><${Letters} at=${[184, 66]} text="outer" tone="second" anchor="start" /><${Letters} at=${[180, 132]} text="3 turns" tone="soft" anchor="start" />
  <//>`;

export const Lissajous = () => html`
  <${Figure} title="Two waves across each other, with the width and the height of the figure.">
    <${Line} tone="accent" d=${polyline(sampled((share) => [112 + 56 * Math.sin(6 * Math.PI * share + Math.PI / 2), 62 + 48 * Math.sin(4 * Math.PI * share)], 200))} />
    <${Length} from=${[56, 126]} to=${[168, 126]} /><${Letters} at=${[178, 130]} text="width" tone="soft" anchor="start" /><${Length} from=${[186, 14]} to=${[186, 110]} /><${Letters} at=${[192, 66]} text="height" tone="soft" anchor="start" />
  <//>`;

export const Letter = () => html`
  <${Figure} title="The letter S in one stroke, with its height.">
    <${Line} tone="accent" d="M146 32C138 14 90 10 90 40S150 62 150 94S94 130 86 106" /><${Length} from=${[176, 18]} to=${[176, 120]} /><${Letters} at=${[184, 74]} text="height" tone="soft" anchor="start" />
    <${Dot} at=${[120, 68]} tone="soft" /><${Letters} at=${[70, 72]} text="x, y" tone="soft" anchor="end" />
  <//>`;

const POINTS = /** @type {[number, number][]} */ ([[36, 104], [74, 34], [138, 54], [204, 26], [190, 110]]);

export const Waypoints = () => html`
  <${Figure} title="Points in the order of the walk, in straight pieces or as a smooth curve through them.">
    <${Line} tone="accent" d=${polyline(POINTS)} /><${Line} dashed tone="soft" d="M36 104C40 70 52 34 74 34S112 58 138 54S190 14 204 26S200 92 190 110" />
    ${POINTS.map((at, index) => html`<${Dot} at=${at} tone=${index === 0 ? "second" : "accent"} size=${5} />`)}<${Letters} at=${[48, 122]} text="first" tone="second" anchor="start" />
  <//>`;
