/** Tells the server what this viewer of the scene wants to see, and hears how its scene is. */
import { keepOpen } from "../live/socket.js";
import { get, set } from "../store.js";
import { remember, toggled } from "./layers.js";

/** @type {((text: string) => void) | null} */
let send = null;

const LESS_MOTION = matchMedia("(prefers-reduced-motion: reduce)");

/** A name for one viewer: chance, since two pages must not share one. */
export function newViewer() {
  const bytes = crypto.getRandomValues(new Uint8Array(8));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** @param {string} viewer @returns {() => void} closes it */
export function openChannel(viewer) {
  const unheard = { watching: null, follows: false };
  const socket = keepOpen(`/api/v1/scene?viewer=${viewer}`, {
    message(data, answer) {
      const { type, watching, full_field_mT, follows } = JSON.parse(data);
      if (type !== "scene") return;
      if (send === null) {
        send = answer;
        tell({ type: "show", layers: get().scene.layers });
      }
      note({ watching, full_field_mT: full_field_mT ?? get().scene.full_field_mT, follows });
    },
    lost() {
      send = null;
      note(unheard);
    },
  });
  return () => {
    socket.close();
    send = null;
    note(unheard);
  };
}

const note = (/** @type {object} */ change) => set({ scene: { ...get().scene, ...change } });
const tell = (/** @type {object} */ wish) => send?.(JSON.stringify(wish));

/** @param {string} name */
export function toggleLayer(name) {
  const layers = toggled(get().scene.layers, name);
  note({ layers });
  remember(layers);
  tell({ type: "show", layers });
}

/** @param {string} name */
export const look = (name) => tell({ type: "view", name, smooth: !LESS_MOTION.matches });
