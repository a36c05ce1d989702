/** The field that turns the robot and presses one of its ends down. */
import { html } from "../../view.js";
import { polar, polyline } from "./geometry.js";
import { Angle, Arrow, Figure, Letters, Line } from "./parts.js";

const FOOT = /** @type {[number, number]} */ ([70, 104]);

/** From the side: the bar stands on one end, as far out of the plate as the field is tilted. */
export const Tilt = () => html`
  <${Figure} title="The robot from the side: the tilted field presses one end down and lifts the other.">
    <${Line} tone="soft" d="M20 112H220" /><${Line} tone="soft" dashed d=${polyline([FOOT, [210, 104]])} />
    <path class="figure-body" d=${polyline([FOOT, polar(FOOT, 92, 24)])} />
    <circle class="figure-pivot" data-stands="true" cx=${FOOT[0]} cy=${FOOT[1]} r="5" /><circle class="figure-pivot" cx=${polar(FOOT, 92, 24)[0]} cy=${polar(FOOT, 92, 24)[1]} r="5" />
    <${Angle} at=${FOOT} radius=${62} from=${0} to=${24} tone="accent" /><${Letters} at=${[144, 96]} text="α" tone="accent" />
    <${Arrow} from=${[168, 44]} to=${[112, 69]} tone="second" /><${Letters} at=${[124, 52]} text="B" tone="second" anchor="end" />
    <${Letters} at=${[70, 132]} text="pivot, pressed down" tone="soft" /><${Letters} at=${[206, 130]} text="plate" tone="soft" />
  <//>`;

const CENTRE = /** @type {[number, number]} */ ([96, 98]);

/** Slanted, so that the plate is seen as a plane: the polar angle in it, the tilt out of it. */
export const Field = () => html`
  <${Figure} title="The field vector over the plate: its direction in the plate, its tilt out of it and its strength.">
    <path class="figure-plate" d="M20 122L78 66H228L170 122Z" />
    <${Arrow} from=${CENTRE} to=${[206, 98]} tone="soft" /><${Letters} at=${[214, 106]} text="x" tone="soft" />
    <${Arrow} from=${CENTRE} to=${[122, 72]} tone="soft" /><${Letters} at=${[114, 68]} text="y" tone="soft" />
    <${Line} dashed tone="soft" d="M96 98L192 86M192 86V30" />
    <${Arrow} from=${CENTRE} to=${[192, 28]} tone="accent" /><${Letters} at=${[146, 46]} text="|B|" tone="accent" anchor="end" />
    <path class="figure-line" data-tone="second" d="M166 98A70 70 0 0 0 165.4 89.3" /><${Letters} at=${[172, 98]} text="φ" tone="second" anchor="start" />
    <path class="figure-line" data-tone="second" d="M145.6 91.8A50 50 0 0 0 136.4 68.5" /><${Letters} at=${[149, 81]} text="α" tone="second" anchor="start" />
  <//>`;
