/** A scene that nobody can see costs network and battery: after a while in a hidden tab it is put away. */
import { useEffect, useState } from "../view.js";

const HIDDEN_MS = 60000;

/** @returns {boolean} */
export function useAsleep() {
  const [asleep, setAsleep] = useState(false);
  useEffect(() => {
    let timer = 0;
    const heed = () => {
      clearTimeout(timer);
      if (document.hidden) timer = setTimeout(() => setAsleep(true), HIDDEN_MS);
      else setAsleep(false);
    };
    heed();
    document.addEventListener("visibilitychange", heed);
    return () => {
      clearTimeout(timer);
      document.removeEventListener("visibilitychange", heed);
    };
  }, []);
  return asleep;
}
