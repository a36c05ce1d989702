/** What this rig is: program, board, camera, and room on the disk. */
import { bytes, when } from "../runs/words.js";
import { useStore } from "../store.js";
import { fixed, quantity } from "../units.js";
import { html } from "../view.js";
import { useRigPage } from "./settings.js";

export function About() {
  const about = useRigPage((page) => page.about);
  if (!about) return html`<p class="hint padded">Asking what there is…</p>`;
  return html`
    <div class="rig-about">
      <${Program} about=${about} /><${Board} /><${Camera} about=${about} /><${Disk} data=${about.data} />
    </div>
  `;
}

const Facts = ({ title, children }) => html`<section aria-label=${title}><h3>${title}</h3><dl class="facts">${children}</dl></section>`;
const Fact = ({ title, children }) => html`<div><dt>${title}</dt><dd>${children}</dd></div>`;

function Program({ about: { program } }) {
  const libraries = Object.entries(program.libraries).map(([name, version]) => `${name} ${version}`).join(", ");
  return html`
    <${Facts} title="Program">
      <${Fact} title="pivotrig">${program.version}<//>
      <${Fact} title="Running since">${when(program.started_at)}<//>
      <${Fact} title="Python">${program.python}, ${program.system}<//>
      <${Fact} title="Libraries">${libraries}<//>
    <//>
  `;
}

function Board() {
  const link = useStore((state) => state.tick?.link);
  return html`
    <${Facts} title="Board">
      <${Fact} title="Port">${link?.port ?? "–"}<//>
      <${Fact} title="Link">${link?.state ?? "–"}${typeof link?.round_trip_median_ms === "number" && `, ${quantity(link.round_trip_median_ms, "ms")} there and back`}<//>
      <${Fact} title="Firmware">${link?.firmware || "–"}<//>
      <${Fact} title="Supply">${quantity(link?.supply_V, "V")}<//>
      <${Fact} title="Bad frames">${link?.bad_frames ?? "–"}<//>
    <//>
  `;
}

function Camera({ about: { camera } }) {
  const rate = useStore((state) => state.tick?.loop?.rate_Hz);
  return html`
    <${Facts} title="Camera">
      <${Fact} title="Source">${camera.uri}<//>
      <${Fact} title="Identity">${camera.identity || "–"}<//>
      <${Fact} title="Picture">${camera.size_px.join(" × ")} px<//>
      <${Fact} title="Rate">${fixed(rate, 0)} of ${fixed(camera.rate_Hz, 0)} pictures a second<//>
      ${camera.trouble && html`<${Fact} title="Trouble">${camera.trouble}<//>`}
    <//>
  `;
}

function Disk({ data }) {
  const taken = data.total_bytes ? 1 - data.free_bytes / data.total_bytes : null;
  return html`
    <${Facts} title="Data folder">
      <${Fact} title="Path"><code>${data.folder}</code><//>
      <${Fact} title="Free">${bytes(data.free_bytes)} of ${bytes(data.total_bytes)}
        ${taken !== null && html`<meter min="0" max="1" high="0.9" value=${taken} aria-label="Taken share of the disk">${fixed(100 * taken, 0)} %</meter>`}<//>
    <//>
  `;
}
