/** The page. */
import { Bar, stateWord } from "./bar/bar.js";
import { ConsentDialog } from "./bar/consent.js";
import { Notices } from "./bar/notices.js";
import { Wizard } from "./calibration/wizard.js";
import { Camera } from "./camera/camera.js";
import { Charts } from "./charts/charts.js";
import { Journal } from "./journal/journal.js";
import { stopOnKeysIn } from "./keys/keys.js";
import { connect } from "./live/connection.js";
import { RunPanel } from "./run/panel.js";
import { ReplayBar } from "./replay/bar.js";
import { followAddress } from "./replay/replay.js";
import { ReplayRoom } from "./replay/room.js";
import { Scene } from "./scene/scene.js";
import { useStore } from "./store.js";
import { html, render, useEffect } from "./view.js";

const root = document.getElementById("app");

function Page({ retry }) {
  const lost = useStore((state) => state.connection.status === "lost");
  const settingUp = useStore((state) => state.setup !== null);
  const replaying = useStore((state) => state.replay !== null);
  const title = useStore((state) => `${stateWord(state.tick)} – ${state.rig?.name ?? "pivotrig"}`);
  useEffect(() => void (document.title = lost ? "no connection – pivotrig" : title), [lost, title]);
  return html`
    <div class="page" data-connection=${lost ? "lost" : "fine"} data-setting-up=${settingUp} data-shown=${replaying ? "replay" : "live"}>
      <${Bar} />
      <${Notices} retry=${retry} />
      <${ConsentDialog} />
      ${replaying && html`<${ReplayBar} />`}
      <main inert=${lost}>
        ${replaying ? html`<${ReplayRoom} key="replay" />` : html`<${RigRoom} key="rig" />`}
        <${Journal} key="journal" />
      </main>
    </div>
  `;
}

/** What shows the rig and acts on it. */
const RigRoom = () => html`<${Camera} /><${Wizard} /><${Scene} /><${RunPanel} /><${Charts} />`;

stopOnKeysIn(window);
const socket = connect();
root.replaceChildren();
followAddress();
render(html`<${Page} retry=${socket.retry} />`, root);
