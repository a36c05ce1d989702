/** Under the bar of the rig while a recording is shown: which one it is, its whole length to scrub, how it is played. */
import { stateWord } from "../bar/bar.js";
import { useStore } from "../store.js";
import { html, useEffect, useRef } from "../view.js";
import { closeReplay, useReplay } from "./replay.js";
import { RetrackButton } from "./retrack.js";
import { Scrubber } from "./scrubber.js";
import { Badge, Line } from "./signs.js";
import { Transport } from "./transport.js";

export function ReplayBar() {
  const status = useReplay((replay) => replay.status);
  const bar = useRef(null);
  // In place of the button that has opened it: the player is what comes next.
  useEffect(() => bar.current.focus({ preventScroll: true }), []);
  useEffect(() => {
    const root = document.documentElement.style;
    const watch = new ResizeObserver(() => root.setProperty("--replay-height", `${bar.current?.offsetHeight ?? 0}px`));
    watch.observe(bar.current);
    return () => {
      watch.disconnect();
      root.removeProperty("--replay-height");
    };
  }, []);
  return html`
    <section class="replay-bar" aria-label="Replay" tabindex="-1" ref=${bar}>
      <div class="replay-head">
        <${Badge} />
        ${status === "loading" ? html`<span class="soft">Reading the recording…</span>` : html`<${Names} />`}
        <${RigMeanwhile} />
        ${status !== "loading" && html`<${RetrackButton} />`}
        <button class="replay-close" type="button" onClick=${closeReplay}>Back to live</button>
      </div>
      <${Trouble} />
      ${status !== "loading" && html`<div class="replay-player"><${Transport} /><${Scrubber} /></div>`}
    </section>
  `;
}

function Names() {
  const runs = useReplay((replay) => replay.runs);
  return html`
    <ul class="replay-names">
      ${runs.map((run, index) => html`
        <li key=${run.id} title=${run.id}>${runs.length > 1 && html`<${Line} index=${index} />`}
          <strong>${run.name}</strong> <span class="soft">${run.parts} · <time datetime=${run.run.started_at}>${run.started}</time></span></li>
      `)}
    </ul>
  `;
}

const QUIET = ["disarmed", "connecting"];

/** Nobody shall forget that the rig itself is up to something. */
function RigMeanwhile() {
  const word = useStore((state) => (state.connection.status === "lost" ? "not known" : stateWord(state.tick)));
  if (QUIET.includes(word)) return null;
  return html`<p class="replay-meanwhile" role="note" data-state=${word}>The rig itself: <strong>${word}</strong></p>`;
}

function Trouble() {
  const { status, cause } = useReplay((replay) => ({ status: replay.status, cause: replay.cause })) ?? {};
  const torn = useReplay((replay) => replay.runs.some((run) => !run.isWhole));
  if (status === "lost") return html`<p class="replay-trouble" role="alert">The recording cannot be read just now: ${cause}. It goes on by itself as soon as it can.</p>`;
  if (torn) return html`<p class="replay-trouble">This recording was torn: what could be saved of it is shown.</p>`;
  return null;
}
