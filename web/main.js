/** The page. */
import { Bar, stateWord } from "./bar/bar.js";
import { ConsentDialog } from "./bar/consent.js";
import { Notices } from "./bar/notices.js";
import { Camera } from "./camera/camera.js";
import { Journal } from "./journal/journal.js";
import { lazy } from "./journal/lazy.js";
import { HelpPopover } from "./help/popover.js";
import { heedKeysIn } from "./keys/bindings.js";
import { stopOnKeysIn } from "./keys/keys.js";
import { connect } from "./live/connection.js";
import { recall } from "./notify/device.js";
import { RunPanel } from "./run/panel.js";
import { followAddress } from "./replay/replay.js";
import { Scene } from "./scene/scene.js";
import { useStore } from "./store.js";
import { Tour } from "./tour/tour.js";
import { html, render, useEffect } from "./view.js";

const root = /** @type {HTMLElement} */ (document.getElementById("app"));

const Charts = lazy(() => import("./charts/charts.js").then((module) => module.Charts), "the charts", "charts");
const Wizard = lazy(() => import("./calibration/wizard.js").then((module) => module.Wizard), "the camera’s setup");
const ReplayBar = lazy(() => import("./replay/bar.js").then((module) => module.ReplayBar), "the recording");
const ReplayRoom = lazy(() => import("./replay/room.js").then((module) => module.ReplayRoom), "the recording");

/** @param {{retry: () => void}} props tries the lost connection again */
function Page({ retry }) {
  useStanding();
  const connection = useStore((state) => state.connection.status);
  const lost = connection === "lost";
  const settingUp = useStore((state) => state.setup !== null);
  const replaying = useStore((state) => state.replay !== null);
  const title = useStore((state) => `${stateWord(state.tick)} – ${state.rig?.name ?? "pivotrig"}`);
  useEffect(() => void (document.title = lost ? "no connection – pivotrig" : title), [lost, title]);
  return html`
    <div class="page" data-connection=${connection} data-setting-up=${settingUp} data-shown=${replaying ? "replay" : "live"}>
      <${Bar} />
      <${Notices} retry=${retry} />
      <${ConsentDialog} />
      ${replaying && html`<${ReplayBar} />`}
      <main inert=${lost}>
        ${replaying ? html`<${ReplayRoom} key="replay" />` : html`<${RigRoom} key="rig" />`}
        <${Journal} key="journal" />
      </main>
      <${HelpPopover} />
      <${Tour} />
    </div>
  `;
}

/** What shows the rig and acts on it. */
function RigRoom() {
  const settingUp = useStore((state) => state.setup !== null);
  return html`<${Camera} />${settingUp && html`<${Wizard} />`}<${Scene} /><${RunPanel} /><${Charts} />`;
}

/** Tells the browser's own stopwatch when what is seen first stands with data: whoever measures the page looks there. */
function useStanding() {
  const stands = useStore(({ tick, rig, selection }) => tick !== null && rig !== null && selection !== null);
  useEffect(() => {
    if (!stands) return undefined;
    const frame = requestAnimationFrame(() => performance.mark("dashboard stands"));
    return () => cancelAnimationFrame(frame);
  }, [stands]);
}

stopOnKeysIn(window);
heedKeysIn(window);
recall();
const socket = connect();
root.replaceChildren();
followAddress();
render(html`<${Page} retry=${socket.retry} />`, root);
