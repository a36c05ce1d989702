/** STOP by key from anywhere on the page. It is heard before everything else and needs nothing that could be broken. */
import { stopNow } from "../live/stop.js";
import { isTyping } from "./typing.js";

/** @param {KeyboardEvent} event */
const isStop = (event) => event.key === "Escape" || (event.key === " " && !isTyping(event));

/** @param {KeyboardEvent} event */
function onKeyDown(event) {
  if (!isStop(event)) return;
  event.preventDefault();
  if (!event.repeat) stopNow();
}

/** A focused button is pressed when the space bar comes up again, not by its going down. @param {KeyboardEvent} event */
function onKeyUp(event) {
  if (event.key === " " && !isTyping(event)) event.preventDefault();
}

/** Also for the window of the scene: keys that are pressed in a frame do not reach the page around it. @param {Window} target */
export function stopOnKeysIn(target) {
  target.addEventListener("keydown", onKeyDown, true);
  target.addEventListener("keyup", onKeyUp, true);
}
