/** STOP by key from anywhere on the page, and `?` for the sheet of keys. */
import { stopNow } from "../live/actions.js";
import { html, useEffect, useRef } from "../view.js";

const KEYS = [
  ["Escape", "STOP: coils to zero, from anywhere, also with this sheet open"],
  ["Space", "STOP, except while typing in a text field (press buttons with Enter)"],
  ["?", "this sheet"],
  ["Tab, Shift + Tab", "next, previous control"],
  ["Enter", "press the focused button, take over the focused value"],
  ["K", "play or pause a recording that is shown (J, L: 5 s back, on; , and .: one picture)"],
  ["[ ] \\", "begin, end, leave the part of it that is played again and again"],
  ["Arrows", "move the crosshair in the camera picture while it waits for a click (Shift: far; Enter: click)"],
];

const TEXT_INPUTS = "textarea, [contenteditable=true], input:not([type=checkbox]):not([type=radio]):not([type=button]):not([type=range])";
export const isTyping = (event) => event.target instanceof event.view.Element && event.target.matches(TEXT_INPUTS);
const isStop = (event) => event.key === "Escape" || (event.key === " " && !isTyping(event));

function onKeyDown(event) {
  if (!isStop(event)) return;
  event.preventDefault();
  if (!event.repeat) stopNow();
}

// A focused button is pressed when the space bar comes up again, not by its going down.
function onKeyUp(event) {
  if (event.key === " " && !isTyping(event)) event.preventDefault();
}

/** Also for the window of the scene: keys that are pressed in a frame do not reach the page around it. */
export function stopOnKeysIn(target) {
  target.addEventListener("keydown", onKeyDown, true);
  target.addEventListener("keyup", onKeyUp, true);
}

export function KeySheet() {
  const dialog = useRef(null);
  useEffect(() => {
    const open = (event) => {
      if (event.key === "?" && !isTyping(event)) dialog.current.showModal();
    };
    addEventListener("keydown", open);
    return () => removeEventListener("keydown", open);
  }, []);
  useEffect(() => {
    const close = (event) => event.key === "Escape" && dialog.current.close();
    addEventListener("keydown", close, true);
    return () => removeEventListener("keydown", close, true);
  }, []);
  return html`
    <button class="quiet" type="button" aria-haspopup="dialog" onClick=${() => dialog.current.showModal()}>Keys <kbd>?</kbd></button>
    <dialog ref=${dialog} aria-labelledby="keys-title">
      <h2 id="keys-title">Keys</h2>
      <dl class="keys">${KEYS.map(([key, text]) => html`<div><dt><kbd>${key}</kbd></dt><dd>${text}</dd></div>`)}</dl>
      <form method="dialog"><button type="submit">Close</button></form>
    </dialog>
  `;
}
