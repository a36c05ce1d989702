/** What can be connected: boards on serial ports, and cameras; one click puts it into the draft. */
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html, useEffect } from "../view.js";
import { change, learn, put, useRigPage } from "./settings.js";

export function Connections() {
  useEffect(() => void look(), []);
  return html`
    <header class="rig-head"><h2>Connections</h2><p class="hint">What is plugged into the rig’s computer. Nothing is opened to find it.</p></header>
    <div class="row"><button type="button" onClick=${look}>Look again</button></div>
    <${Ports} /><${Cameras} />
  `;
}

function look() {
  change({ ports: null, cameras: null });
  learn("ports");
  learn("cameras");
}

const useSimulatedOnly = () => useStore((state) => Boolean(state.rig?.file?.overridden?.some((path) => path === "camera.uri" || path === "link.port")));

function Ports() {
  const ports = useRigPage((page) => page.ports);
  const used = useStore((state) => state.rig?.link?.port);
  return html`
    <section class="rig-group" aria-label="Boards"><h3>Boards</h3>
      <${List} things=${ports} none="No serial port on USB is plugged in." looking="Looking for boards…" row=${(port) => ({
        key: port.device, name: port.board || port.description || port.device, about: [port.device, port.message].filter(Boolean).join(" · "),
        used: used === port.device || used === port.by_id, use: () => put("link.port", port.by_id || port.device),
      })} />
      ${used?.startsWith("sim://") && html`<p class="hint">In use: the simulated board.</p>`}
    </section>
  `;
}

function Cameras() {
  const cameras = useRigPage((page) => page.cameras);
  return html`
    <section class="rig-group" aria-label="Cameras"><h3>Cameras</h3>
      <${List} things=${cameras} none="No camera is plugged in." looking="Looking for cameras…" row=${(camera) => ({
        key: camera.uri, name: camera.name, about: aboutOf(camera), used: camera.in_use, use: () => put("camera.uri", camera.uri),
      })} />
    </section>
  `;
}

/** The largest picture and the fastest rate. */
function aboutOf({ path, sizes, rates_Hz: rates }) {
  const [largest] = [...sizes].sort((one, other) => other[0] * other[1] - one[0] * one[1]);
  return [largest && `up to ${largest.join(" × ")} px`, rates.length > 0 && `${fixed(Math.max(...rates), 0)} pictures a second`, path].filter(Boolean).join(" · ");
}

function List({ things, none, looking, row }) {
  const simulated = useSimulatedOnly();
  if (things === null) return html`<p class="hint">${looking}</p>`;
  if (things.length === 0) return html`<p class="hint">${none}</p>`;
  return html`
    <ul class="rig-things">
      ${things.map(row).map(({ key, name, about, used, use }) => html`
        <li key=${key}><span><strong>${name}</strong><span class="soft">${about}</span></span>
          ${used ? html`<span class="soft">in use</span>` : html`<button type="button" disabled=${simulated} title=${simulated ? "This server was started with --sim" : undefined} onClick=${use}>Use</button>`}</li>`)}
    </ul>
  `;
}
