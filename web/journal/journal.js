/** Below the live part: the runs, the studies and the log. */
import { Runs } from "../runs/runs.js";
import { useStore } from "../store.js";
import { Studies } from "../studies/studies.js";
import { html, useRef } from "../view.js";
import { Log } from "./log.js";
import { showTab, useTab } from "./tab.js";

const TABS = [["runs", "Runs", Runs], ["studies", "Studies", Studies], ["log", "Log", Log]];

export function Journal() {
  const open = useTab();
  const list = useRef(null);
  const faults = useStore((state) => state.tick?.faults?.length ?? 0);
  const move = (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const index = (TABS.findIndex(([name]) => name === open) + step + TABS.length) % TABS.length;
    showTab(TABS[index][0]);
    list.current.children[index].focus();
  };
  const Page = TABS.find(([name]) => name === open)[2];
  return html`
    <section class="card journal" aria-label="Runs, studies and log">
      <div class="tabs" role="tablist" aria-label="Runs, studies and log" ref=${list} onKeyDown=${move}>
        ${TABS.map(([name, title]) => html`
          <button type="button" role="tab" id=${`tab-${name}`} aria-controls="tab-page" aria-selected=${name === open}
            tabindex=${name === open ? 0 : -1} onClick=${() => showTab(name)}>${title}${name === "log" && faults > 0 ? ` (${faults} open)` : ""}</button>
        `)}
      </div>
      <div class="tab-page" data-tab=${open} role="tabpanel" id="tab-page" aria-labelledby=${`tab-${open}`} tabindex=${open === "log" ? 0 : -1}><${Page} /></div>
    </section>
  `;
}
