/** The printed board: where to get it, and on a simulated rig the one that is shown to the camera. */
import { put } from "../live/rest.js";
import { get, say, useStore } from "../store.js";
import { html } from "../view.js";
import { Do, Outcome } from "./parts.js";
import { change, doing, useSetup } from "./setup.js";

const PLACE = "board";

export function BoardLink({ board }) {
  return html`
    <a class="download" href="/api/v1/calibration/board.pdf" target="_blank" rel="noopener">Print the board (PDF)</a>
    <span class="hint">${board.columns} × ${board.rows} squares of ${board.square_mm} mm: print at 100 %, glue it onto something flat.</span>
  `;
}

export const useSimulated = () => useStore((state) => Boolean(state.tick?.simulated));

/** pose: "flat" on the plate, or held in the "next" way. */
export async function showBoard(pose) {
  await put("/simulation/board", { shown: true, pose });
  change({ board: pose });
  return true;
}

/** Nothing stays on the plate of a simulated rig, or nobody would see the robot again. */
export async function clearPlate(more = {}) {
  if (!get().setup?.board) return;
  change({ board: null });
  await put("/simulation/board", { shown: false }, more).catch((problem) => say(problem.message));
}

/** Somebody has left the board before the simulated camera. */
export function LeftBoard() {
  const left = useSetup((setup) => setup.board !== null) ?? false;
  if (!left) return null;
  return html`
    <div class="guard" role="group" aria-label="Printed board">
      <p>The printed board lies before the simulated camera and hides the robot.</p>
      <button type="button" onClick=${() => clearPlate()}>Take the board away</button>
    </div>
  `;
}

/** pose: as for `showBoard`. */
export function ShowBoard({ pose, children }) {
  const shown = useSetup((setup) => setup.board === pose);
  const show = () => doing(PLACE, "Showing the board", () => showBoard(pose));
  const clear = () => doing(PLACE, "Taking the board away", () => clearPlate());
  return html`
    <div class="row simulated">
      <span class="badge">SIM</span>
      <${Do} needsRest=${!shown} pressed=${shown} act=${shown ? clear : show}>${shown ? "Take the board away" : children}<//>
    </div>
    <${Outcome} place=${PLACE} />
  `;
}
