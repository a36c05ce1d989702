/** The robot's colour: click it, look at the mask, use it. */
import { createMask } from "../camera/mask.js";
import { ALONE, useLayer, usePointer } from "../camera/pointing.js";
import { trackingReason, trackingWords } from "../camera/tracking.js";
import { patch, post } from "../live/rest.js";
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html, useState } from "../view.js";
import { Sliders } from "./colour_sliders.js";
import { separationGrade } from "./grades.js";
import { outline } from "./drawing.js";
import { Do, Fact, Outcome, Saved } from "./parts.js";
import { Profiles } from "./profiles.js";
import { doing, learn, saving, useSetup } from "./setup.js";

const PLACE = "vision";
const PARTS = { body: "robot", end_mark: "mark on end A" };
/** Body fields of PATCH /vision for each part. */
const FIELDS = { body: "colour", end_mark: "end_mark" };

export function ColourStep() {
  const vision = useSetup((setup) => setup.vision);
  const [part, setPart] = useState("body");
  const [draft, setDraft] = useState(null);
  const [shown, setShown] = useState(true);
  const saved = vision?.[FIELDS[part]] ?? null;
  const colour = draft?.colour ?? saved;
  useMask(shown ? colour : null, draft?.box_px);
  usePointer({ words: `Click the ${PARTS[part]}`, press: (place) => pick(place, part, setDraft) });
  const choose = (next) => {
    setPart(next);
    setDraft(null);
  };
  if (!vision) return html`<p class="hint">Asking for the colours in use…</p><${Outcome} place=${PLACE} />`;
  return html`
    <p class="lead">${part === "body"
      ? "Click the robot in the picture; what counts as robot then lights up. It should be the robot, whole, and nothing else."
      : "Click the coloured mark on end A in the picture; it tells the robot's two ends apart."}</p>
    <label class="switch"><input type="checkbox" checked=${shown} onChange=${(event) => setShown(event.target.checked)} />Show what counts as ${PARTS[part]}</label>
    ${draft?.separation !== undefined && html`<${Proposal} draft=${draft} />`}
    ${colour && html`<${Sliders} colour=${colour} onChange=${(next) => setDraft({ ...draft, colour: next })} />`}
    <div class="row">
      <${Do} primary needsRest disabled=${!draft} act=${() => use(part, draft, setDraft)}>Use this colour<//>
      <${Do} disabled=${!draft} act=${() => setDraft(null)}>Cancel<//>
    </div>
    <${Outcome} place=${PLACE} />
    <${EndMark} part=${part} choose=${choose} mark=${vision.end_mark} />
    <${Profiles} vision=${vision} />
    <${Now} vision=${vision} />
  `;
}

function useMask(colour, box) {
  const [mask] = useState(createMask);
  useLayer((pen) => {
    if (!colour) return null;
    mask(pen, colour);
    if (box) outline(pen, boxCorners(box));
    return ALONE;
  }, [colour, box]);
}

const boxCorners = ([u0, v0, u1, v1]) => [[u0, v0], [u1, v0], [u1, v1], [u0, v1]];

async function pick({ u, v }, part, setDraft) {
  const proposal = await doing(PLACE, "Looking at the colours", () => post("/vision/pick", { u, v, part }));
  if (proposal) setDraft({ ...proposal, part });
}

async function use(part, draft, setDraft) {
  const body = { [FIELDS[part]]: draft.colour };
  if (part === "body" && draft.area_mm2) body.area_mm2 = draft.area_mm2;
  if ((await saving(PLACE, "Saving the colour", () => patch("/vision", body))) === null) return;
  setDraft(null);
  await learn("vision");
}

function Proposal({ draft }) {
  const grade = separationGrade(draft.separation);
  return html`
    <dl class="facts">
      <${Fact} title="Separation" grade=${grade}>${fixed(draft.separation * 100, 0)} %<//>
      ${typeof draft.light_change === "number" && html`<${Fact} title="Bears other light">up to ${fixed(draft.light_change * 100, 0)} % brighter or darker<//>`}
      ${draft.area_mm2 && html`<${Fact} title="Size of a robot">${draft.area_mm2.map((area) => fixed(area, 0)).join(" to ")} mm²<//>`}
    </dl>
    ${(draft.warnings ?? []).length > 0 && html`<ul class="warnings">${draft.warnings.map((text) => html`<li>${text}</li>`)}</ul>`}
  `;
}

function EndMark({ part, choose, mark }) {
  return html`
    <details class="more">
      <summary>Mark on end A <span class="soft">${mark ? "in use" : "optional"}</span></summary>
      <p class="hint">A dab of another colour on end A tells the two ends apart for good, also when the robot was out of sight.</p>
      <div class="row">
        ${part === "body"
          ? html`<${Do} act=${() => choose("end_mark")}>Pick the mark’s colour<//>`
          : html`<${Do} act=${() => choose("body")}>Back to the robot’s colour<//>`}
        ${mark && html`<${Do} needsRest act=${forgetMark}>Remove the mark<//>`}
      </div>
    </details>
  `;
}

async function forgetMark() {
  await saving(PLACE, "Removing the mark", () => patch("/vision", { end_mark: null }));
  await learn("vision");
}

function Now({ vision }) {
  const tick = useStore((state) => state.tick);
  const reason = trackingReason(tick);
  return html`
    <${Saved}>
      <${Fact} title="Lighting">${vision.profile}<//>
      <${Fact} title="Hue">${vision.colour.hue_deg.map((end) => fixed(end, 0)).join("° to ")}°<//>
      <${Fact} title="Tracking">${trackingWords(tick)}${reason && html` <span class="soft">${reason}</span>`}<//>
    <//>
  `;
}
