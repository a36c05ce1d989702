/** What the camera card shows while the rig itself is looked at: the newest picture, and what the rig knows of it. */
import { keepOpen } from "../live/socket.js";
import { live, onTick } from "../live/ticks.js";
import { get } from "../store.js";
import { drawnLayers, onPointingChange } from "./pointing.js";

/** Pictures are asked for at most this often: more cannot be told apart and costs the rig's computer, ms. */
const PICTURE_MS = 33;

/** @implements the source of `createPainter` */
export const rigPictures = {
  camera: () => get().camera,

  /** The next picture is asked for once this one is on the screen: a hidden page asks for none. */
  open(view, show) {
    let asked = 0;
    return keepOpen(`/api/v1/camera?view=${view}`, {
      message(data, send) {
        const next = () => {
          asked = performance.now();
          send("ok");
        };
        show(data, () => setTimeout(next, PICTURE_MS - (performance.now() - asked)));
      },
    });
  },

  onChange: onTick,
  onLayers: onPointingChange,
  layers: drawnLayers,

  /** While the camera is set up the picture shows what the camera sees, not what a run would do. */
  over() {
    const { path, runPath, rig, setup } = get();
    const length_mm = rig?.robot?.length_mm;
    if (setup !== null) return { path: null, trail: [], tick: live.tick, length_mm };
    return { path: (runPath ?? path)?.points_mm, trail: live.trail, tick: live.tick, length_mm };
  },
};
