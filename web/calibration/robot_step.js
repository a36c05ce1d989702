/** The robot: pivot length and heading offset from a walked star, and how late the pictures are. */
import { post } from "../live/rest.js";
import { get, useStore } from "../store.js";
import { html, useEffect } from "../view.js";
import { figuresOf, numbersOf } from "./figures.js";
import { Do, Fact, Outcome, Saved } from "./parts.js";
import { doing, learn, saving, useSetup } from "./setup.js";

const POLL_MS = 500;

/** The delay comes first: without it a robot that swings as fast as in a star is not where it seems to be. */
const WALKS = {
  latency: {
    title: "Camera delay", start: "Measure the delay", walking: "The robot turns to and fro",
    about: "The robot turns to and fro on the spot, for half a minute. Its picture follows late, by the camera’s delay.",
  },
  star: {
    title: "Star", start: "Walk a star", walking: "The robot walks a star",
    about: "The robot walks out and back in several directions, for about a minute. That tells its pivot length and how its heading lies to its way.",
  },
};

const goesOn = (known) => ["walking", "working_out"].includes(known?.stage);

export function RobotStep() {
  return html`
    <p class="lead">Let the robot move by itself, twice: that tells how late the pictures come, and then how the robot is built.</p>
    ${Object.keys(WALKS).map((name) => html`<${Walk} key=${name} name=${name} ...${WALKS[name]} />`)}
    <${Now} />
  `;
}

/** Asks how far a walk is, as long as it goes on. */
function useProgress(name, on) {
  useEffect(() => {
    if (!on) return undefined;
    const timer = setInterval(() => learn(name), POLL_MS);
    return () => clearInterval(timer);
  }, [name, on]);
}

function Walk({ name, title, start, walking, about }) {
  const known = useSetup((setup) => setup[name]);
  const on = goesOn(known);
  useProgress(name, on);
  return html`
    <section class="walk" aria-label=${title}>
      <h3>${title}</h3>
      <p class="hint">${about}</p>
      ${on && html`<p class="working"><progress max="1" value=${known.progress} aria-label=${walking}></progress>${known.stage === "walking" ? walking : "Working it out"}…</p>`}
      ${known?.stage === "failed" && html`<p class="field-error" role="alert">${known.reason}</p>`}
      ${known?.figures && html`<dl class="facts">${figuresOf(name, known.figures).map(([label, text]) => html`<${Fact} title=${label}>${text}<//>`)}</dl>`}
      <${WalkButtons} name=${name} start=${start} known=${known} on=${on} />
      <${Outcome} place=${name} />
    </section>
  `;
}

/** Usual star: legs and their length, mm. */
const STAR = { legs: 5, leg_mm: 20 };
/** The slip of all legs together may carry the robot this far, and shorter legs tell too little, mm. */
const DRIFT_MM = 11;
const SHORTEST_MM = 5;

/** Shorter legs, and more of them, where the robot stands near the workspace's edge. */
function starThatFits() {
  const { tick, rig } = get();
  const off = Math.max(Math.abs(tick?.pose?.x_mm ?? 0), Math.abs(tick?.pose?.y_mm ?? 0));
  const room = (rig?.limits?.workspace_mm ?? Infinity) / 2 - DRIFT_MM - off;
  if (!(room >= SHORTEST_MM)) return STAR;
  const leg = Math.min(STAR.leg_mm, Math.floor(room));
  return { legs: Math.round((STAR.legs * STAR.leg_mm) / leg), leg_mm: leg };
}

function WalkButtons({ name, start, known, on }) {
  const armed = useStore(({ tick }) => tick?.rig === "armed");
  const elsewhere = useSetup(({ star, latency }) => goesOn(star) || goesOn(latency));
  const fresh = Boolean(known?.figures) && !known.saved;
  const begin = async () => {
    await doing(name, "Starting", () => post(`/calibration/${name}`, name === "star" ? starThatFits() : {}));
    await learn(name);
  };
  const save = async () => {
    await saving(name, "Saving", () => post(`/calibration/${name}/save`));
    await learn(name);
  };
  return html`
    <div class="row">
      <${Do} primary=${!fresh} disabled=${!armed || on || elsewhere} act=${begin}>${start}<//>
      ${fresh && html`<${Do} primary needsRest act=${save}>Save<//>`}
    </div>
  `;
}

function Now() {
  const known = useSetup(({ star, latency }) => ({ star, latency }));
  const used = Object.keys(WALKS).flatMap((name) => numbersOf(name, known?.[name]?.in_use));
  const sources = [known?.latency?.in_use?.source, known?.star?.in_use?.source];
  return html`
    <${Saved}>
      ${used.map(([title, text]) => html`<${Fact} title=${title}>${text}<//>`)}
      <${Fact} title="Delay from">${sources[0] ?? "–"}<//>
      <${Fact} title="Star from">${sources[1] ?? "–"}<//>
    <//>
  `;
}
