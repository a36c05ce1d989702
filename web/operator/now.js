/** A clock that goes while somebody looks at it. */
import { useEffect, useState } from "../view.js";

const LOOK_MS = 250;

/** @param {boolean} goes @returns {number} performance.now(), a few times a second */
export function useNow(goes) {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    if (!goes) return undefined;
    const look = () => setNow(performance.now());
    const timer = setInterval(look, LOOK_MS);
    look();
    return () => clearInterval(timer);
  }, [goes]);
  return goes ? Math.max(now, performance.now()) : performance.now();
}
