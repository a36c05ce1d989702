/** The page while a recording is shown: everything of the rig's page that a recording can fill. */
import { useKeys } from "../keys/bindings.js";
import { Scene } from "../scene/scene.js";
import { html } from "../view.js";
import { ReplayCamera } from "./camera.js";
import { ReplayCharts } from "./charts.js";
import { playOnKeysIn, REPLAY_KEYS } from "./keys.js";
import { ReplayPanel } from "./panel.js";
import { useReplay } from "./replay.js";
import { Badge } from "./signs.js";

export function ReplayRoom() {
  useKeys("Recording", REPLAY_KEYS);
  return html`<${ReplayCamera} /><${ReplayScene} /><${ReplayPanel} /><${ReplayCharts} />`;
}

function ReplayScene() {
  const session = useReplay((replay) => replay.session);
  return html`<${Scene} key=${session ?? "none"} session=${session} badge=${html`<${Badge} />`} onWindow=${playOnKeysIn} />`;
}
