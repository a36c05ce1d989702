/** The camera's setup: five calm steps beside the picture. The page's own STOP and Escape stay in force. */
import { useStore } from "../store.js";
import { html, useEffect, useRef } from "../view.js";
import { clearPlate, LeftBoard } from "./board.js";
import { CameraStep } from "./camera_step.js";
import { ColourStep } from "./colour_step.js";
import { Guard } from "./guard.js";
import { LensStep } from "./lens_step.js";
import { PlaneStep } from "./plane_step.js";
import { RobotStep } from "./robot_step.js";
import { closeSetup, goTo, learnOfRig, STEPS, useSetup } from "./setup.js";
import { BOARD_STEPS, useStanding } from "./standing.js";

const PAGES = {
  camera: ["Camera", CameraStep],
  colour: ["Colour", ColourStep],
  lens: ["Lens", LensStep],
  plane: ["Plane", PlaneStep],
  robot: ["Robot", RobotStep],
};

export function Wizard() {
  const open = useStore((state) => state.setup !== null);
  return open ? html`<${Panel} />` : null;
}

function Panel() {
  const step = useSetup((setup) => setup.step) ?? "camera";
  const title = useRef(null);
  const page = useRef(null);
  const rig = useStore((state) => state.rig);
  useEffect(() => title.current?.focus(), []);
  const known = useRef(rig);
  useEffect(() => {
    if (known.current !== rig) learnOfRig();
    known.current = rig;
  }, [rig]);
  useEffect(() => {
    const leave = () => clearPlate({ keepalive: true });
    addEventListener("pagehide", leave);
    return () => removeEventListener("pagehide", leave);
  }, []);
  useEffect(() => {
    page.current?.scrollTo(0, 0);
    return clearPlate;
  }, [step]);
  const [name, Step] = PAGES[step];
  const index = STEPS.indexOf(step);
  return html`
    <section class="card wizard" aria-labelledby="wizard-title">
      <header class="card-head">
        <h2 id="wizard-title" ref=${title} tabindex="-1">Set up the camera</h2>
        <button class="quiet close" type="button" onClick=${close}>Close</button>
      </header>
      <${Steps} step=${step} />
      <${Guard} moving=${step === "robot"} />
      ${!BOARD_STEPS.includes(step) && html`<${LeftBoard} />`}
      <div class="step" id="wizard-step" role="tabpanel" aria-label=${name} ref=${page}><${Step} key=${step} /></div>
      <footer class="wizard-foot">
        <button type="button" disabled=${index === 0} onClick=${() => goTo(STEPS[index - 1])}>Back</button>
        ${index < STEPS.length - 1
          ? html`<button type="button" onClick=${() => goTo(STEPS[index + 1])}>Next: ${PAGES[STEPS[index + 1]][0]}</button>`
          : html`<button type="button" onClick=${close}>Finish</button>`}
      </footer>
    </section>
  `;
}

/** The focus goes back to where it came from. */
function close() {
  clearPlate();
  closeSetup();
  requestAnimationFrame(() => document.getElementById("set-up-camera")?.focus());
}

const MARKS = { done: "✓", wrong: "!", open: "" };
const MEANINGS = { done: "done", wrong: "needs attention", open: "not done" };

function Steps({ step }) {
  const standing = useStanding();
  const list = useRef(null);
  const move = (event) => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by) return;
    const next = (STEPS.indexOf(step) + by + STEPS.length) % STEPS.length;
    goTo(STEPS[next]);
    list.current.children[next].focus();
  };
  return html`
    <div class="steps" role="tablist" aria-label="Steps" ref=${list} onKeyDown=${move}>
      ${STEPS.map((name, index) => html`
        <button type="button" role="tab" aria-controls="wizard-step" aria-selected=${name === step} tabindex=${name === step ? 0 : -1}
          data-standing=${standing[name]} onClick=${() => goTo(name)}>
          <span class="number" aria-hidden="true">${MARKS[standing[name]] || index + 1}</span>
          <span>${PAGES[name][0]}</span><span class="unseen">, ${MEANINGS[standing[name]]}</span>
        </button>
      `)}
    </div>
  `;
}
