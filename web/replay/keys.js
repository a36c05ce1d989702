/** Keys of the replay. Space and Escape stay what they are on the whole page: STOP. */
import { heedKeysIn } from "../keys/bindings.js";
import { endLoop, loopFromHere, loopToHere, seekBy, step, toggle } from "./player.js";

const LEAP_S = 5;

/** @type {import("../keys/register.js").Binding[]} */
export const REPLAY_KEYS = [
  { key: "k", words: "Play or pause", act: toggle },
  { key: "j", words: `${LEAP_S} s back`, act: () => seekBy(-LEAP_S), repeats: true },
  { key: "l", words: `${LEAP_S} s on`, act: () => seekBy(LEAP_S), repeats: true },
  { key: ",", words: "One picture back", act: () => step(-1), repeats: true },
  { key: ".", words: "One picture on", act: () => step(1), repeats: true },
  { key: "[", words: "Play again and again from here", act: loopFromHere },
  { key: "]", words: "Play again and again up to here", act: loopToHere },
  { key: "\\", words: "Leave the part that is played again and again", act: endLoop },
];

/** Also for the window of the scene, whose keys do not reach the page. */
export const playOnKeysIn = heedKeysIn;
