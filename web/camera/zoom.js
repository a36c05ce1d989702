/** The part of a picture that is shown, as something that can be watched. */
import { WHOLE } from "./viewport.js";

/** @returns {Zoom} */
export function createZoom() {
  let view = WHOLE;
  const listeners = new Set();
  return {
    get: () => view,
    set(next) {
      if (next === view) return;
      view = next;
      for (const listener of listeners) listener();
    },
    onChange(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}

/**
 * @typedef {import("./viewport.js").Viewport} Viewport
 * @typedef {{get: () => Viewport, set: (view: Viewport) => void, onChange: (listener: () => void) => () => void}} Zoom
 */
