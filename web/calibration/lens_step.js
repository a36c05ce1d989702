/** The lens: how it bends straight lines, from views of a printed board. */
import { useLayer } from "../camera/pointing.js";
import { post, remove } from "../live/rest.js";
import { quantity } from "../units.js";
import { html, useEffect } from "../view.js";
import { BoardLink, clearPlate, ShowBoard, useSimulated } from "./board.js";
import { CoverageMap } from "./coverage.js";
import { dots } from "./drawing.js";
import { dateWords, lensGrade } from "./grades.js";
import { Do, Fact, Outcome, Saved, useDisarmed } from "./parts.js";
import { doing, learn, saving, useSetup } from "./setup.js";
import { forgetFound, stopTaking, takeViews, useTaking } from "./views.js";

const PLACE = "calibration";

export function LensStep() {
  const calibration = useSetup((setup) => setup.calibration);
  const found = useSetup((setup) => setup.found) ?? null;
  const covered = calibration?.session.covered_px ?? [];
  useEffect(() => stopTaking, []);
  useLayer((pen) => {
    dots(pen, covered, 0.3);
    if (found?.newest) dots(pen, found.newest);
  }, [covered, found]);
  if (!calibration) return html`<p class="hint">Asking for the calibration…</p><${Outcome} place=${PLACE} />`;
  const { session, lens, board } = calibration;
  return html`
    <p class="lead">Hold the printed board into the picture, each time elsewhere and at another slant, until the map is full.</p>
    <${Board} board=${board} />
    <${CoverageMap} session=${session} />
    <p class="view-hint" aria-live="polite">${found?.hint ?? session.hint}</p>
    <${Buttons} session=${session} />
    ${session.pending_lens && html`<${Pending} lens=${session.pending_lens} />`}
    <${Outcome} place=${PLACE} saved="Saved. The plane comes next: each lens needs its own." />
    <${Now} lens=${lens} />
  `;
}

function Board({ board }) {
  const simulated = useSimulated();
  return html`
    <div class="row"><${BoardLink} board=${board} /></div>
    ${simulated && html`<${ShowBoard} pose="next">Show the printed board<//>`}
  `;
}

function Buttons({ session }) {
  const simulated = useSimulated();
  const disarmed = useDisarmed();
  const taking = useTaking();
  return html`
    <div class="row">
      <${Do} primary=${!session.enough} disabled=${simulated && !disarmed} act=${() => (taking ? stopTaking() : takeViews(simulated))}>${taking ? "Pause" : "Take views"}<//>
      <${Do} primary=${session.enough && !session.pending_lens} disabled=${session.views === 0 || taking} act=${solve}>Work out the lens<//>
      ${session.views > 0 && html`<${Do} quiet disabled=${taking} act=${startAgain}>Start again<//>`}
    </div>
  `;
}

async function solve() {
  await doing(PLACE, "Working out the lens", () => post("/calibration/lens"));
  await learn("calibration");
}

async function startAgain() {
  await doing(PLACE, "Forgetting the views", () => remove("/calibration/lens/views"));
  forgetFound();
  await learn("calibration");
}

async function save() {
  if ((await saving(PLACE, "Saving the lens", () => post("/calibration/save"))) === null) return;
  await clearPlate();
  forgetFound();
  await learn("calibration");
}

function Pending({ lens }) {
  const dropped = lens.dropped?.length ?? 0;
  return html`
    <section class="pending" aria-label="Found">
      <dl class="facts">
        <${Fact} title="Residual" grade=${lensGrade(lens)}>${quantity(lens.residual_px, "px", 2)}<//>
        <${Fact} title="From">${lens.views} views${dropped > 0 && html` <span class="soft">(${dropped} did not fit and were left out)</span>`}<//>
      </dl>
      <div class="row"><${Do} primary needsRest act=${save}>Save the lens<//></div>
    </section>
  `;
}

function Now({ lens }) {
  return html`
    <${Saved} none=${!lens && "No lens calibration: the lens is as the rig file assumes."} fits=${lens?.fits ?? true} why=${lens?.why_not}>
      ${lens && html`
        <${Fact} title="Residual" grade=${lensGrade(lens)}>${quantity(lens.residual_px, "px", 2)}<//>
        <${Fact} title="From">${lens.views} views, ${dateWords(lens.date)}<//>
        <${Fact} title="Camera">${lens.identity}, ${lens.size_px.join(" × ")} px<//>`}
    <//>
  `;
}
