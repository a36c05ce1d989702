/** Takes views of the board one after the other, by itself, while somebody moves it about. */
import { post, Problem } from "../live/rest.js";
import { get } from "../store.js";
import { showBoard } from "./board.js";
import { change, learn, note, useSetup } from "./setup.js";

const PLACE = "calibration";
/** Time to move the board, ms. */
const PAUSE_MS = 600;
const SIMULATED_PAUSE_MS = 50;

export const useTaking = () => useSetup((setup) => Boolean(setup.taking)) ?? false;

export const stopTaking = () => change({ taking: null });

export const forgetFound = () => change({ found: null });

const pause = (duration) => new Promise((resolve) => setTimeout(resolve, duration));

/** Until there are enough, or somebody pauses. simulated: the page moves the board itself. */
export async function takeViews(simulated) {
  const turn = {};
  const goesOn = () => get().setup?.taking === turn;
  note("errors", PLACE, "");
  note("done", PLACE, "");
  change({ taking: turn });
  while (goesOn()) {
    if (simulated && !(await shownElsewhere())) break;
    if (goesOn() && !(await takeOne())) break;
    await pause(simulated ? SIMULATED_PAUSE_MS : PAUSE_MS);
  }
  if (goesOn()) stopTaking();
  await learn("calibration");
}

const shownElsewhere = () => going(() => showBoard("next"));

/** @returns whether to go on: not after a failure, nor when there are enough views */
const takeOne = () =>
  going(async () => {
    const look = await post("/calibration/lens/views").catch(noBoard);
    if (look === null) return true;
    const { setup } = get();
    if (!setup) return false;
    const { session } = setup.calibration;
    const covered = look.taken ? [...session.covered_px, ...look.corners_px] : session.covered_px;
    const { views, coverage, enough, hint } = look;
    change({
      found: { newest: look.corners_px, hint },
      calibration: { ...setup.calibration, session: { ...session, views, coverage, enough, hint, covered_px: covered } },
    });
    return !enough;
  });

/** No board in this picture: its words are the hint, and the next picture may have one. */
function noBoard(problem) {
  if (problem.status !== 422) throw problem;
  change({ found: { newest: null, hint: problem.message } });
  return null;
}

/** What `work` answers; a refusal is said beside the buttons and ends the taking. */
async function going(work) {
  try {
    return await work();
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    note("errors", PLACE, problem.message);
    return false;
  }
}
