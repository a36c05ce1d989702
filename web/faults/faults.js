/** The tab that only a simulated rig has: put a fault in, and see the rig keep what it promises. */
import { useStore } from "../store.js";
import { html, useEffect } from "../view.js";
import { isWatching, loadFaults, putIn, takeAllAway, takeAway, usualOf } from "./catalogue.js";
import { Others } from "./others.js";
import { Reactions } from "./reactions.js";
import { FIRST } from "./words.js";

/** While the rig is watched, what it has done is asked for this often, ms. */
const LOOK_MS = 400;

export function Faults() {
  const faults = useStore((state) => state.faults);
  const watching = useStore(isWatching);
  useEffect(() => void loadFaults(), []);
  useEffect(() => {
    if (!watching) return undefined;
    const timer = setInterval(loadFaults, LOOK_MS);
    return () => clearInterval(timer);
  }, [watching]);
  if (!faults) return html`<p class="hint padded">Loading the faults…</p>`;
  return html`
    <div class="faults">
      <${Walking} />
      <${First} faults=${faults} />
      <${PutIn} faults=${faults} />
      <${Reactions} faults=${faults} />
      <${Others} faults=${faults} />
    </div>
  `;
}

function Walking() {
  const walks = useStore((state) => state.tick?.rig === "running");
  return html`<p class="hint faults-hint">${walks
    ? "The robot walks. Put a fault in, and see beneath whether the rig keeps its promise."
    : "The rig’s promises are about a robot that walks: arm and start a run first, then put a fault in."}</p>`;
}

/** One big button each; pressed again it takes the fault away. */
function First({ faults }) {
  const byName = new Map(faults.map((fault) => [fault.name, fault]));
  return html`
    <div class="first-faults" role="group" aria-label="Try one of these">
      ${FIRST.filter(([name]) => byName.has(name)).map(([name, words, what]) => html`<${Big} key=${name} fault=${byName.get(name)} words=${words} what=${what} />`)}
    </div>
  `;
}

function Big({ fault, words, what }) {
  const isIn = fault.injected !== null;
  const press = () => (isIn ? takeAway(fault.name) : putIn(fault.name, { parameters: usualOf(fault) }));
  return html`
    <button class="big-fault" type="button" aria-pressed=${fault.happens_once ? undefined : isIn} onClick=${press}>
      <b>${words}</b><span>${isIn ? "is in: press to take it away" : what}</span>
    </button>
  `;
}

function PutIn({ faults }) {
  const now = useStore((state) => Math.floor(state.tick?.time_s ?? 0));
  const isIn = faults.filter(({ injected }) => injected !== null);
  return html`
    <section class="put-in" aria-labelledby="put-in-title">
      <header><h3 id="put-in-title">Put in now</h3>
        ${isIn.length > 1 && html`<button type="button" onClick=${takeAllAway}>Take all away</button>`}</header>
      ${isIn.length === 0 && html`<p class="hint">Nothing: the rig works as it should.</p>`}
      <ul>${isIn.map((fault) => html`
        <li key=${fault.name}>
          <span><b>${fault.title}</b> <span class="soft">${sinceWords(fault.injected, now)}</span></span>
          <button type="button" aria-label=${`Take away: ${fault.title}`} onClick=${() => takeAway(fault.name)}>Take away</button>
        </li>`)}</ul>
    </section>
  `;
}

function sinceWords({ since_s, until_s, is_on }, now) {
  const since = `for ${Math.max(0, Math.round(now - since_s))} s`;
  const until = until_s === null ? "" : `, ${Math.max(0, Math.round(until_s - now))} s left`;
  return `${since}${until}${is_on ? "" : ", away just now"}`;
}
