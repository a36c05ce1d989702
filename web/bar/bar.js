/** The bar: what rig this is, what it does and why, how well the loop runs, and STOP. */
import { countIn } from "../faults/catalogue.js";
import { showTab } from "../journal/tab.js";
import { trackingWords } from "../camera/tracking.js";
import { KeySheet } from "../keys/sheet.js";
import { stopNow } from "../live/stop.js";
import { OperatorSign } from "../operator/sign.js";
import { RecordingSign } from "../runs/sign.js";
import { useStore } from "../store.js";
import { quantity } from "../units.js";
import { html, useEffect, useRef } from "../view.js";

export function Bar() {
  const tick = useStore((state) => state.tick);
  const rig = useStore((state) => state.rig);
  const bar = useRef(null);
  useEffect(() => {
    const tell = () => document.documentElement.style.setProperty("--bar-height", `${bar.current.offsetHeight}px`);
    const watch = new ResizeObserver(tell);
    watch.observe(bar.current);
    return () => watch.disconnect();
  }, []);
  return html`
    <header class="bar" ref=${bar}>
      <div class="bar-name">
        <h1>${rig?.name ?? "pivotrig"}</h1>
        ${(tick?.simulated ?? rig?.simulated) && html`<span class="badge" title="No coil is real: camera, robot and board are simulated">SIM</span>`}
      </div>
      <${FaultsIn} />
      <${State} tick=${tick} />
      <${RecordingSign} recording=${tick?.recording} />
      <${Vitals} tick=${tick} />
      <${OperatorSign} />
      <${KeySheet} />
      <button class="stop" type="button" onClick=${stopNow} aria-keyshortcuts="Escape Space" title="Coils to zero, at once (Escape or Space)">STOP</button>
    </header>
  `;
}

/** So that nobody wonders why a simulated rig fails. */
function FaultsIn() {
  const count = useStore(countIn);
  if (count === 0) return null;
  return html`<button class="faults-in" type="button" title="Show the faults" onClick=${() => showTab("faults")}>${count === 1 ? "1 fault" : `${count} faults`}<span class="when-wide"> put in</span></button>`;
}

export const stateWord = (tick) => tick?.rig ?? "connecting";

/** The reason in words; of several faults the first cause, as the rig gives it. */
function reasonOf(tick) {
  if (!tick) return "";
  return tick.reason || tick.faults?.[0]?.message || "";
}

function State({ tick }) {
  const word = stateWord(tick);
  const reason = reasonOf(tick);
  return html`
    <div class="state" role="status" data-state=${tick?.rig ?? "unknown"}>
      <span class="state-word">${word}</span>
      ${reason && html`<span class="state-reason" title=${reason}>${reason}</span>`}
      <span class="unseen">, robot ${tick ? trackingWords(tick).split(" for ")[0] : "unknown"}</span>
    </div>
  `;
}

function Vitals({ tick }) {
  const loop = tick?.loop;
  const link = tick?.link;
  return html`
    <dl class="vitals">
      <div title="Frames a second that went through the loop; ${loop?.dropped_frames ?? 0} dropped so far. A picture arrives this late after it was taken">
        <dt>Camera</dt><dd>${quantity(loop?.rate_Hz, "fps", 0)}${lateness(tick)}</dd></div>
      <div title="From frame in to bytes out: median, and 99th percentile">
        <dt>Loop</dt><dd>${quantity(loop?.latency_p50_ms, "ms")} <span class="soft">p99 ${quantity(loop?.latency_p99_ms, "ms")}</span></dd></div>
      <div title="${coilDetail(tick)}"><dt>Coils</dt><dd>${percent(hottest(tick))}${tick?.limited_by && html` <span class="soft">limited</span>`}</dd></div>
      <div title="${linkDetail(link)}"><dt>Link</dt><dd>${link?.state ?? "–"} <span class="soft">${roundTrip(link)}</span></dd></div>
    </dl>
  `;
}

/** How late pictures come, as far as it is known. */
function lateness(tick) {
  const late = tick?.camera?.latency_ms;
  return typeof late === "number" ? html` <span class="soft">${quantity(late, "ms late", 0)}</span>` : null;
}

const hottest = (tick) => (tick?.coil_heat ? Math.max(...tick.coil_heat) : null);
const percent = (share) => quantity(typeof share === "number" ? share * 100 : null, "%", 0);

function coilDetail(tick) {
  const each = (tick?.coil_heat ?? []).map((share, index) => `${"xyz"[index]} ${percent(share)}`).join(", ");
  const heat = `Estimated heat of the hottest coil, of what it may have (${each}); from 100 % on it must cool to 80 %`;
  return tick?.limited_by ? `${heat}. The field is held back by: ${tick.limited_by}` : heat;
}

const roundTrip = (link) => (typeof link?.round_trip_ms === "number" ? quantity(link.round_trip_ms, "ms", 0) : "");

function linkDetail(link) {
  if (!link) return "not known yet";
  const parts = [link.port, `firmware ${link.firmware}`, `board ${link.board_state}`, `supply ${quantity(link.supply_V, "V")}`];
  return [...parts, `${link.bad_frames} bad frames`, ...(link.board_faults ?? [])].join(" · ");
}
