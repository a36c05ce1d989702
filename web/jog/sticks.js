/** Looks at the gamepad while the jog is on; a page that is hidden is not called, and looks at nothing. */
import { get } from "../store.js";
import { useEffect, useState } from "../view.js";
import { createStickWatch, firstPad } from "./gamepad.js";
import { changeSwing, isHeldBy, press, release, swingAt } from "./jog.js";

/** @typedef {import("./hold.js").Swing} Swing */

const BY = "gamepad";

const pads = () => navigator.getGamepads?.() ?? [];

/** @returns {string} what the gamepad is called, "" for none */
export function useSticks() {
  const [name, setName] = useState("");
  useEffect(() => {
    const look = createStickWatch({
      press: (/** @type {Swing} */ swing) => press(BY, swing), change: (/** @type {Swing} */ swing) => changeSwing(BY, swing),
      release: () => release(BY), isHeld: () => isHeldBy(BY),
    });
    let frame = 0;
    const turn = () => {
      const pad = firstPad(pads());
      setName(pad ? /** @type {any} */ (pad).id || "gamepad" : "");
      look(pad, ({ pivot, rate_deg_s }) => swingAt(pivot, rate_deg_s), get().jog.rate_deg_s);
      frame = requestAnimationFrame(turn);
    };
    turn();
    return () => {
      cancelAnimationFrame(frame);
      release(BY);
    };
  }, []);
  return name;
}
