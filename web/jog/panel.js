/** Drive by hand: hold a button, a key or a stick, and the robot swings about one of its ends. */
import { useKeys } from "../keys/bindings.js";
import { get, useStore } from "../store.js";
import { quantity } from "../units.js";
import { html, useEffect } from "../view.js";
import { obstacleOf, press, release, setRate, SLOWEST_DEG_S, swing, switchJog, watchHand } from "./jog.js";
import { useSticks } from "./sticks.js";

/** @type {[pivot: 1 | -1, end: string, ways: [sense: 1 | -1, key: string, words: string][]][]} to the left and to the right */
const ENDS = [
  [1, "A", [[1, "q", "left"], [-1, "e", "right"]]],
  [-1, "B", [[1, "a", "left"], [-1, "d", "right"]]],
];
/** @type {Record<string, string>} */
const ARROWS = { left: "↺", right: "↻" };
const FASTEST_DEG_S = 180;

export function JogPanel() {
  const on = useStore((state) => state.jog.on);
  return html`
    <section class="jog" aria-label="Jog">
      <button class="jog-switch" type="button" aria-expanded=${on} onClick=${() => switchJog(!on)}>
        <span>Jog</span><span class="soft">${on ? "on" : "drive by hand"}</span>
      </button>
      ${on && html`<${Jog} />`}
    </section>
  `;
}

const KEYS = ENDS.flatMap(([pivot, end, ways]) => ways.map(([sense, key, words]) => ({
  key, words: `Hold: turn ${words} about ${end}`,
  act: () => press(`key ${key}`, swing(pivot, sense)), release: () => release(`key ${key}`),
  when: () => obstacleOf(get()) === "",
})));

function Jog() {
  const obstacle = useStore(obstacleOf);
  const { held, refusal } = useStore((state) => state.jog);
  const gamepad = useSticks();
  useKeys("Jog", KEYS);
  useEffect(watchHand, []);
  return html`
    <div class="jog-hands">
      ${ENDS.map(([pivot, end, ways]) => html`
        <div class="jog-end" role="group" aria-label=${`About end ${end}`}>
          <span class="jog-name">about <b>${end}</b></span>
          ${ways.map(([sense, key, words]) => html`
            <${Pad} pivot=${pivot} end=${end} sense=${sense} sign=${key} words=${words} disabled=${obstacle !== ""} />`)}
        </div>`)}
      <${Rate} />
      <p class=${refusal && !obstacle ? "jog-words refused" : "jog-words hint"} role="status">${obstacle || refusal || wordsOf(held)}</p>
      <p class="hint">${gamepad ? `Gamepad: ${gamepad}. Hold LB or RB and tilt the left stick (A) or the right one (B).` : "Gamepad: press one of its buttons and it is found."}</p>
    </div>
  `;
}

/** @param {import("../types").State["jog"]["held"]} held */
function wordsOf(held) {
  if (!held) return "Hold a button or its key. Letting go stops the robot.";
  const { pivot, rate_deg_s } = held.swing;
  return `Turning ${rate_deg_s > 0 ? "left" : "right"} about ${pivot === 1 ? "A" : "B"} at ${quantity(Math.abs(rate_deg_s), "deg/s", 0)}`;
}

/** Held by mouse, finger, or Enter; a finger that slides off or is taken away by the system has let go. @param {any} props */
function Pad({ pivot, end, sense, sign, words, disabled }) {
  const pressed = useStore(({ jog: { held } }) => held !== null && held.swing.pivot === pivot && Math.sign(held.swing.rate_deg_s) === sense);
  const by = `pad ${end} ${words}`;
  const down = (/** @type {any} */ event) => {
    if (event.button !== 0 || !event.isPrimary) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    press(by, swing(pivot, sense));
  };
  const up = () => release(by);
  const key = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    if (event.type === "keyup") up();
    else if (!event.repeat) press(by, swing(pivot, sense));
  };
  useEffect(() => up, []);
  return html`
    <button class="jog-pad" type="button" disabled=${disabled} aria-label=${`Turn ${words} about ${end}`} aria-pressed=${pressed} aria-keyshortcuts=${sign.toUpperCase()}
      onPointerDown=${down} onPointerUp=${up} onPointerCancel=${up} onLostPointerCapture=${up} onBlur=${up}
      onContextMenu=${(/** @type {MouseEvent} */ event) => event.preventDefault()} onKeyDown=${key} onKeyUp=${key}>
      <span class="jog-arrow" aria-hidden="true">${ARROWS[words]}</span>${words}<kbd aria-hidden="true">${sign.toUpperCase()}</kbd>
    </button>
  `;
}

function Rate() {
  const rate = useStore((state) => state.jog.rate_deg_s);
  const fastest = useStore((state) => Math.min(FASTEST_DEG_S, state.rig?.limits?.rate_deg_s ?? FASTEST_DEG_S));
  return html`
    <label class="jog-rate">
      <span>Rate</span>
      <input type="range" min=${SLOWEST_DEG_S} max=${fastest} step="5" value=${rate} aria-valuetext=${quantity(rate, "deg/s", 0)}
        onInput=${(/** @type {any} */ event) => setRate(Number(event.target.value))} />
      <span class="jog-figure" aria-hidden="true">${quantity(rate, "deg/s", 0)}</span>
    </label>
  `;
}
