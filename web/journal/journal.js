/** Below the live part: the runs, the studies, what is calibrated, the rig's file and the log. */
import { useKeys } from "../keys/bindings.js";
import { useStore } from "../store.js";
import { Badge } from "../log/badge.js";
import { html, useEffect, useRef } from "../view.js";
import { lazy } from "./lazy.js";
import { openTabOfAddress, showTab, useTab } from "./tab.js";

/** [name, title, page, simulated: only on a simulated rig] */
const TABS = [
  { name: "runs", title: "Runs", Page: lazy(() => import("../runs/runs.js").then((module) => module.Runs), "the runs") },
  { name: "studies", title: "Studies", Page: lazy(() => import("../studies/studies.js").then((module) => module.Studies), "the studies") },
  { name: "calibration", title: "Calibration", Page: lazy(() => import("../calibration/overview.js").then((module) => module.Overview), "the calibration") },
  { name: "rig", title: "Rig", Page: lazy(() => import("../rig/rig.js").then((module) => module.Rig), "the rig’s settings") },
  { name: "log", title: "Log", Page: lazy(() => import("../log/log.js").then((module) => module.Log), "the log") },
  { name: "faults", title: "Faults", Page: lazy(() => import("../faults/faults.js").then((module) => module.Faults), "the faults"), simulated: true },
];

openTabOfAddress(TABS.map(({ name }) => name));

const LABEL = "Runs, studies, calibration, rig and log";

export function Journal() {
  const wanted = useTab();
  const simulated = useStore((state) => Boolean(state.tick?.simulated ?? state.rig?.simulated));
  const tabs = TABS.filter((tab) => simulated || !tab.simulated);
  const open = tabs.find(({ name }) => name === wanted) ?? tabs[0];
  const list = useRef(null);
  useEffect(() => intoView(list.current, document.getElementById(`tab-${open.name}`)), [open.name]);
  const move = (event) => {
    const index = targetOf(event.key, tabs.indexOf(open), tabs.length);
    if (index === null) return;
    event.preventDefault();
    showTab(tabs[index].name);
    document.getElementById(`tab-${tabs[index].name}`)?.focus();
  };
  useKeys("Tabs", tabs.map(({ name, title }, index) => ({ key: String(index + 1), words: title, act: () => goTo(name) })));
  return html`
    <section class="card journal" aria-label=${LABEL}>
      <div class="tabs" role="tablist" aria-label=${LABEL} ref=${list} onKeyDown=${move}>
        ${tabs.map(({ name, title }) => html`
          <button type="button" role="tab" key=${name} id=${`tab-${name}`} aria-controls="tab-page" aria-selected=${name === open.name}
            tabindex=${name === open.name ? 0 : -1} onClick=${() => showTab(name)}>${title}${name === "log" && html`<${Badge} />`}</button>
        `)}
      </div>
      <div class="tab-page" data-tab=${open.name} role="tabpanel" id="tab-page" aria-labelledby=${`tab-${open.name}`}><${open.Page} key=${open.name} /></div>
    </section>
  `;
}

/** By a key of the page: the tab comes into view, and has the focus. */
function goTo(name) {
  showTab(name);
  document.getElementById(`tab-${name}`)?.focus();
}

/** @returns {number | null} the tab that a key leads to */
function targetOf(key, from, count) {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[key];
  if (step) return (from + step + count) % count;
  return { Home: 0, End: count - 1 }[key] ?? null;
}

/** On a phone the row of tabs scrolls sideways; the page itself stays where it is. */
function intoView(row, tab) {
  if (!tab) return;
  const left = tab.offsetLeft - (row.clientWidth - tab.offsetWidth) / 2;
  row.scrollTo({ left });
}
