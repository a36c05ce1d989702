/** Keys while a path is drawn and the camera card has the focus. */
import { isTyping } from "../keys/typing.js";
import { redo, undo } from "./drawing.js";

/** @param {KeyboardEvent} event */
export function drawKeys(event) {
  if (!(event.ctrlKey || event.metaKey) || isTyping(event)) return;
  const name = event.key.toLowerCase();
  const act = name === "y" || (name === "z" && event.shiftKey) ? redo : name === "z" ? undo : null;
  if (!act) return;
  event.preventDefault();
  act();
}
