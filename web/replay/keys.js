/** Keys of the replay. Space and Escape stay what they are on the whole page: STOP. */
import { isTyping } from "../keys/keys.js";
import { endLoop, loopFromHere, loopToHere, seekBy, step, toggle } from "./player.js";

const LEAP_S = 5;

const KEYS = {
  k: toggle, j: () => seekBy(-LEAP_S), l: () => seekBy(LEAP_S),
  ",": () => step(-1), ".": () => step(1),
  "[": loopFromHere, "]": loopToHere, "\\": endLoop,
};

function onKeyDown(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || isBusy(event)) return;
  const act = KEYS[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  if (!event.repeat || act !== toggle) act();
}

/** Text, a list to choose from and a dialog that waits for an answer have the keys. */
const isBusy = (event) => isTyping(event) || event.target.matches?.("select") || document.querySelector("dialog[open]") !== null;

/** @returns () => void takes them away; also for the window of the scene, whose keys do not reach the page. */
export function playOnKeysIn(target) {
  target.addEventListener("keydown", onKeyDown);
  return () => target.removeEventListener("keydown", onKeyDown);
}
