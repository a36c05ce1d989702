/** STOP by key from anywhere on the page, and `?` for the sheet of keys. */
import { Ask } from "../ask.js";
import { stopNow } from "../live/actions.js";
import { html, useEffect, useState } from "../view.js";

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
/** Also for what a browser itself puts into a field, which comes as a key without a name or a window. */
export const isTyping = (event) => event.target.matches?.(TEXT_INPUTS) ?? false;
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

const isAsked = () => document.querySelector("dialog[open]") !== null;

export function KeySheet() {
  const [open, setOpen] = useState(false);
  const close = () => setOpen(false);
  useEffect(() => {
    const onKey = (event) => event.key === "?" && !isTyping(event) && !isAsked() && setOpen(true);
    addEventListener("keydown", onKey);
    return () => removeEventListener("keydown", onKey);
  }, []);
  return html`
    <button class="quiet" type="button" aria-haspopup="dialog" onClick=${() => setOpen(true)}>Keys <kbd>?</kbd></button>
    ${open && html`
      <${Ask} title="Keys" close=${close}>
        <dl class="keys">${KEYS.map(([key, text]) => html`<div><dt><kbd>${key}</kbd></dt><dd>${text}</dd></div>`)}</dl>
        <button type="button" data-first onClick=${close}>Close</button>
      <//>`}
  `;
}
