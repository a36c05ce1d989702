/** Keys of the page: a component offers them with `useKeys` for as long as it is there. STOP is not one of them. */
import { useEffect, useRef } from "../view.js";
import { bindingOf, register } from "./register.js";
import { isTaken } from "./typing.js";

/** @typedef {import("./register.js").Binding} Binding */

/** Which binding each key that is down has begun, by its place on the keyboard. @type {Map<string, Binding>} */
const down = new Map();

/** @param {string} group heading in the sheet of keys @param {Binding[]} bindings */
export function useKeys(group, bindings) {
  const newest = useRef(bindings);
  newest.current = bindings;
  useEffect(() => {
    const remove = register(group, () => newest.current);
    return () => {
      remove();
      newest.current.forEach(letGo);
    };
  }, [group]);
}

/** @param {KeyboardEvent} event */
function onKeyDown(event) {
  if (event.defaultPrevented || isTaken(event)) return;
  const binding = bindingOf(event);
  if (!binding) return;
  event.preventDefault();
  if (event.repeat && !binding.repeats) return;
  if (binding.release) down.set(event.code, binding);
  binding.act?.(event);
}

/** Also after the layout or a modifier has changed what the key is called: its place stays. @param {KeyboardEvent} event */
function onKeyUp(event) {
  const binding = down.get(event.code);
  down.delete(event.code);
  binding?.release?.(event);
}

/** A page that loses the keyboard never hears of a key that comes up. */
function onBlur() {
  const held = [...down.values()];
  down.clear();
  for (const binding of held) binding.release?.(null);
}

/** Whoever offered this key has left the page; if it is down, it is over. @param {Binding} gone */
function letGo(gone) {
  for (const [code, held] of down) {
    if (held.words !== gone.words) continue;
    down.delete(code);
    held.release?.(null);
  }
}

/** @param {Window} target @returns {() => void} takes the keys away */
export function heedKeysIn(target) {
  target.addEventListener("keydown", onKeyDown);
  target.addEventListener("keyup", onKeyUp);
  target.addEventListener("blur", onBlur);
  return () => {
    target.removeEventListener("keydown", onKeyDown);
    target.removeEventListener("keyup", onKeyUp);
    target.removeEventListener("blur", onBlur);
  };
}
