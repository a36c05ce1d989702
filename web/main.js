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
import { Scene } from "./scene/scene.js";
import { useStore } from "./store.js";
import { html, render, useEffect } from "./view.js";

const root = document.getElementById("app");

function Page({ retry }) {
  const lost = useStore((state) => state.connection.status === "lost");
  const settingUp = useStore((state) => state.setup !== null);
  const title = useStore((state) => `${stateWord(state.tick)} – ${state.rig?.name ?? "pivotrig"}`);
  useEffect(() => void (document.title = lost ? "no connection – pivotrig" : title), [lost, title]);
  return html`
    <div class="page" data-connection=${lost ? "lost" : "fine"} data-setting-up=${settingUp}>
      <${Bar} />
      <${Notices} retry=${retry} />
      <${ConsentDialog} />
      <main inert=${lost}>
        <${Camera} />
        <${Wizard} />
        <${Scene} />
        <${RunPanel} />
        <${Charts} />
        <${Journal} />
      </main>
    </div>
  `;
}

stopOnKeysIn(window);
const socket = connect();
root.replaceChildren();
render(html`<${Page} retry=${socket.retry} />`, root);
