/** The buttons: the next step is the big one, the ways out are beside it. */
import * as rig from "../live/actions.js";
import { obstacleOf } from "../operator/lease.js";
import { useStore } from "../store.js";
import { quantity } from "../units.js";
import { html } from "../view.js";

const START = {
  label: "Start walking", act: rig.startRun, hint: () => "The field holds the robot. Start lets it walk the path.",
};
const PAUSE = { label: "Pause", act: rig.pauseRun, everybody: true, hint: () => "Pause takes the field away and keeps the run." };
const RESUME = {
  label: "Resume", act: rig.resumeRun, hint: () => "On hold with the coils at zero. Resume raises the field again and goes on.",
};
const ARM = { label: "Arm", act: rig.arm, hint: armHint };
const RESET = { label: "Reset", act: rig.reset, hint: () => "The coils are at zero. Two steps lead back: reset, then arm." };

function armHint(tick, selection) {
  if (tick.tracking !== "locked") return "Arming waits until the camera sees the robot.";
  return `The robot rests. Arm raises the field to ${quantity(selection?.gait.field_mT, "mT")}; nothing walks yet.`;
}

/** The next step from here. */
function primary(tick) {
  return { disarmed: ARM, armed: START, running: PAUSE, held: RESUME, fault: RESET }[tick.rig];
}

export function Actions() {
  const tick = useStore((state) => state.tick);
  const gait = useStore((state) => state.selection);
  const busy = useStore((state) => state.busy);
  const obstacle = useStore(obstacleOf);
  if (!tick) return html`<div class="actions"><p class="hint">Waiting for the rig…</p></div>`;
  const { label, act, hint, everybody = false } = primary(tick);
  const why = everybody ? "" : obstacle;
  const active = ["armed", "running", "held"].includes(tick.rig);
  return html`
    <div class="actions">
      <button class="primary" type="button" disabled=${busy !== null || why !== ""} title=${why} onClick=${act}>${label}</button>
      <p class="hint">${why || hint(tick, gait)}</p>
      <div class="secondary">
        <button type="button" disabled=${!tick.run || busy === "stop run"} onClick=${rig.stopRun}>Stop run</button>
        <button type="button" disabled=${!active || busy === "disarm"} onClick=${rig.disarm}>Disarm</button>
      </div>
    </div>
  `;
}
