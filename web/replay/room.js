/** The page while a recording is shown: everything of the rig's page that a recording can fill. */
import { Scene } from "../scene/scene.js";
import { html, useEffect } from "../view.js";
import { ReplayCamera } from "./camera.js";
import { ReplayCharts } from "./charts.js";
import { playOnKeysIn } from "./keys.js";
import { ReplayPanel } from "./panel.js";
import { useReplay } from "./replay.js";
import { Badge } from "./signs.js";

export function ReplayRoom() {
  useEffect(() => playOnKeysIn(window), []);
  return html`<${ReplayCamera} /><${ReplayScene} /><${ReplayPanel} /><${ReplayCharts} />`;
}

function ReplayScene() {
  const session = useReplay((replay) => replay.session);
  const query = session === null ? null : { replay: session };
  return html`<${Scene} key=${session ?? "none"} query=${query} badge=${html`<${Badge} />`} onWindow=${playOnKeysIn} />`;
}
