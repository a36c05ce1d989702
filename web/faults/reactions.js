/** What the rig promised for the newest faults, and beside it what it did. */
import { html } from "../view.js";
import { promiseWords, reactionWords, VERDICTS } from "./words.js";

const SHOWN = 4;

export function Reactions({ faults }) {
  const newest = faults.filter(({ reaction }) => reaction !== null).sort((a, b) => b.reaction.since_s - a.reaction.since_s);
  if (newest.length === 0) return null;
  return html`
    <section class="reactions" aria-labelledby="reactions-title">
      <h3 id="reactions-title">Promised and kept</h3>
      <ul>${newest.slice(0, SHOWN).map((fault) => html`<${Kept} key=${`${fault.name} ${fault.reaction.since_s}`} fault=${fault} />`)}</ul>
    </section>
  `;
}

function Kept({ fault }) {
  const { promise, reaction, title, injected, mends } = fault;
  const [sign, word, why] = VERDICTS[reaction.verdict];
  return html`
    <li class="kept" data-verdict=${reaction.verdict} aria-label=${title}>
      <p class="verdict" role="status"><span aria-hidden="true">${sign}</span> ${word}</p>
      <div>
        <h4>${title}</h4>
        <dl>
          <div><dt>Promised</dt><dd>${promiseWords(promise)} <span class="soft">You see: ${promise.sees}.</span></dd></div>
          <div><dt>Happened</dt><dd>${reactionWords(reaction)} ${reaction.became && html`<span class="soft">It says: ${reaction.reason}.</span>`}</dd></div>
          <div><dt>To go on</dt><dd>${injected && !fault.happens_once ? "Take the fault away; then: " : ""}${promise.go_on}. <span class="soft">It mends ${mends}.</span></dd></div>
        </dl>
        ${why && html`<p class="hint">${why}</p>`}
      </div>
    </li>
  `;
}
