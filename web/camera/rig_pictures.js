/** What the camera card shows while the rig itself is looked at: the newest picture, and what the rig knew of it. */
import { keepOpen } from "../live/socket.js";
import { live, onTick } from "../live/ticks.js";
import { get } from "../store.js";
import { createInstants } from "./instants.js";
import { drawnLayers, onPointingChange } from "./pointing.js";

/** Pictures are asked for at most this often: more cannot be told apart and costs the rig's computer, ms. */
const PICTURE_MS = 33;

const instants = createInstants();
onTick(instants.add);

/** @implements the source of `createPainter` */
export const rigPictures = {
  camera: () => get().camera,

  /** The next picture is asked for once this one is on the screen: a hidden page asks for none. */
  open(view, show) {
    let asked = 0;
    let about;
    return keepOpen(`/api/v1/camera?view=${view}&with_time=1`, {
      message(data, send) {
        if (typeof data === "string") {
          about = JSON.parse(data);
          return;
        }
        const next = () => {
          asked = performance.now();
          send("ok");
        };
        show(data, () => setTimeout(next, PICTURE_MS - (performance.now() - asked)), about);
      },
    });
  },

  onChange: onTick,
  onLayers: onPointingChange,
  layers: drawnLayers,

  /** While the camera is set up or a path is drawn, the picture does not show what a run would do. */
  over(about) {
    const { path, runPath, rig, setup, tool } = get();
    const tick = instants.at(about?.captured_s);
    const length_mm = rig?.robot?.length_mm;
    if (setup !== null) return { path: null, trail: [], tick, length_mm };
    const shown = tool === "draw" ? runPath : (runPath ?? path);
    return { path: shown?.points_mm, trail: live.trail, tick, length_mm };
  },
};
