/** Redraws a component when another part of the picture is shown. */
import { useEffect, useState } from "../view.js";

/**
 * @param {import("./zoom.js").Zoom} zoom
 * @returns {import("./viewport.js").Viewport}
 */
export function useZoom(zoom) {
  const [view, setView] = useState(zoom.get());
  useEffect(() => zoom.onChange(() => setView(zoom.get())), [zoom]);
  return view;
}
