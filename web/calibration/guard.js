/** What the rig's state allows just now, and the one deliberate act that changes it. */
import { arm, disarm, reset } from "../live/actions.js";
import { useStore } from "../store.js";
import { html } from "../view.js";

const RESET = ["Reset", reset];
const DISARM = ["Disarm", disarm];

/** Words and way out in each state, for what changes the camera... */
const CHANGING = {
  armed: ["The rig is armed. Its camera can be changed only while it is disarmed.", DISARM],
  running: ["A run is on. The camera can be changed only while the rig is disarmed.", DISARM],
  held: ["A run is on hold. The camera can be changed only while the rig is disarmed.", DISARM],
  fault: ["The rig has stopped. The camera can be changed once it is reset.", RESET],
};
/** ...and for what lets the robot move. */
const MOVING = {
  disarmed: ["The robot can move once the rig is armed. STOP and Escape end it at any time.", ["Arm", arm]],
  armed: ["The rig is armed and the robot can move. To save what was found, disarm it.", DISARM],
  running: ["The robot is on its way. STOP and Escape end it at any time.", DISARM],
  held: ["The rig holds, with the coils at zero.", DISARM],
  fault: ["The rig has stopped. Reset it, then arm it to go on.", RESET],
};

export function Guard({ moving }) {
  const state = useStore(({ tick }) => tick?.rig ?? "");
  const busy = useStore(({ busy: name }) => name !== null);
  const [words, way] = (moving ? MOVING : CHANGING)[state] ?? [];
  if (!words) return null;
  return html`
    <div class="guard" data-calm=${state === "disarmed"} role="group" aria-label="State of the rig">
      <p>${words}</p>
      <button type="button" disabled=${busy} onClick=${way[1]}>${way[0]}</button>
    </div>
  `;
}
