/** The plane: where the plate lies in the picture, from the board, four corners, or marks. */
import { useLayer } from "../camera/pointing.js";
import { post, remove } from "../live/rest.js";
import { quantity } from "../units.js";
import { html, useState } from "../view.js";
import { BoardLink, clearPlate, ShowBoard, useSimulated } from "./board.js";
import { FourCorners } from "./corners.js";
import { outline } from "./drawing.js";
import { dateWords, planeGrade, residualWords } from "./grades.js";
import { Marks } from "./marks.js";
import { Do, Fact, Outcome, Saved } from "./parts.js";
import { doing, learn, saving, useSetup } from "./setup.js";

const PLACE = "calibration";
const METHODS = [["board", "Board"], ["corners", "Four corners"], ["marks", "Marks"]];
const SOURCES = { board: "the printed board", corners: "four corners", marks: "marks" };

export function PlaneStep() {
  const calibration = useSetup((setup) => setup.calibration);
  const [method, setMethod] = useState("board");
  const pending = calibration?.session.pending_plane ?? null;
  useLayer((pen) => pending?.outline_px && outline(pen, pending.outline_px), [pending]);
  if (!calibration) return html`<p class="hint">Asking for the calibration…</p><${Outcome} place=${PLACE} />`;
  return html`
    <p class="lead">Show the camera where the plate is. The yellow square that then appears must lie on the plate’s workspace.</p>
    <fieldset class="segments wide">
      <legend class="unseen">Way to find the plane</legend>
      ${METHODS.map(([name, title]) => html`
        <label><input type="radio" name="plane-method" checked=${method === name} onChange=${() => setMethod(name)} /><span>${title}</span></label>
      `)}
    </fieldset>
    ${method === "board" && html`<${ByBoard} board=${calibration.board} fresh=${pending === null} />`}
    ${method === "corners" && html`<${FourCorners} solve=${solve} fresh=${pending === null} />`}
    ${method === "marks" && html`<${Marks} solve=${solve} fresh=${pending === null} />`}
    ${pending && html`<${Pending} plane=${pending} />`}
    <${Outcome} place=${PLACE} />
    <${Now} plane=${calibration.plane} lens=${calibration.lens} />
  `;
}

/** What is found is saved next: the steps below offer their own button as the obvious one only while nothing is. */
async function solve(body) {
  await doing(PLACE, "Working out the plane", () => post("/calibration/plane", body));
  await learn("calibration");
}

function ByBoard({ board, fresh }) {
  const simulated = useSimulated();
  return html`
    ${simulated ? html`<${ShowBoard} pose="flat">Lay the printed board on the plate<//>` : html`<div class="row"><${BoardLink} board=${board} /></div>`}
    <p class="hint">The board lies flat on the plate. Its middle becomes the workspace’s centre, its upper edge the far side.</p>
    <div class="row"><${Do} primary=${fresh} act=${() => solve({ method: "board" })}>Look for the board<//></div>
  `;
}

function Pending({ plane }) {
  const save = async () => {
    if ((await saving(PLACE, "Saving the plane", () => post("/calibration/save"))) === null) return;
    await clearPlate();
    await learn("calibration");
  };
  return html`
    <section class="pending" aria-label="Found">
      <${Figures} plane=${plane} />
      ${(plane.remarks ?? []).map((text) => html`<p class="hint">${sentence(text)}</p>`)}
      <div class="row"><${Do} primary needsRest act=${save}>Save the plane<//></div>
    </section>
  `;
}

function Figures({ plane }) {
  return html`
    <dl class="facts">
      <${Fact} title="Residual" grade=${planeGrade(plane)}>${residualWords(plane)} <span class="soft">${quantity(plane.residual_px, "px", 2)}</span><//>
      <${Fact} title="Scale">${quantity(plane.scale_px_mm, "px/mm", 2)}<//>
      <${Fact} title="Camera">${quantity(plane.height_mm, "mm", 0)} above the plate, tilted ${quantity(plane.tilt_deg, "deg")}<//>
    </dl>
  `;
}

const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;

function Now({ plane, lens }) {
  const forget = async () => {
    await saving(PLACE, "Going back to the assumed camera", () => remove("/calibration"));
    await learn("calibration");
  };
  return html`
    <${Saved} none=${!plane && "No plane calibration: a camera that looks straight down is assumed."} fits=${plane?.fits ?? true} why=${plane?.why_not}>
      ${plane && html`
        <${Fact} title="Residual" grade=${planeGrade(plane)}>${residualWords(plane)}<//>
        <${Fact} title="From">${SOURCES[plane.source] ?? plane.source}, ${dateWords(plane.date)}<//>
        <${Fact} title="Scale">${quantity(plane.scale_px_mm, "px/mm", 2)}<//>
        <${Fact} title="Camera">${plane.identity}, ${plane.size_px.join(" × ")} px<//>`}
    <//>
    ${(plane || lens) && html`<div class="row"><${Do} quiet needsRest act=${forget}>Forget lens and plane<//></div>`}
  `;
}
