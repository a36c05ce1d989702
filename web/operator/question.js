/** Under the bar: somebody asks for control, or this page does. It waits there, and takes the focus from nobody. */
import { useStore } from "../store.js";
import { html, useEffect, useState } from "../view.js";
import { answer, release, takeControl } from "./lease.js";
import { isAsking, nameOf, questionWords, standingWords, untilTakeOver, whoOperates } from "./words.js";

const LOOK_MS = 250;

/** A clock that goes while somebody looks at it. @param {boolean} goes @returns {number} performance.now(), a few times a second */
export function useNow(goes) {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    if (!goes) return undefined;
    const look = () => setNow(performance.now());
    const timer = setInterval(look, LOOK_MS);
    look();
    return () => clearInterval(timer);
  }, [goes]);
  return goes ? Math.max(now, performance.now()) : performance.now();
}

export function Questions() {
  const operator = useStore((state) => state.operator);
  const mine = whoOperates(operator) === "you";
  return html`
    <p class="unseen" aria-live="polite">${standingWords(operator, operator.heardAt)}</p>
    ${mine && operator.asking && html`<${Asked} asking=${operator.asking} />`}
    ${!mine && isAsking(operator) && html`<div class="notice" data-severity="info" role="group" aria-label="Asking for control"><${Asking} /></div>`}
  `;
}

/** @param {{asking: NonNullable<import("../types").Operator["asking"]>}} props */
function Asked({ asking }) {
  return html`
    <div class="notice asked" data-severity="connection" role="alert">
      <p><strong>${questionWords(asking)}.</strong> <${Left} words="Without an answer it may be taken over" /></p>
      <div class="choice">
        <button type="button" onClick=${() => answer("grant")}>Give</button>
        <button type="button" onClick=${() => answer("refuse")}>Keep</button>
      </div>
    </div>
  `;
}

/** What becomes of the question of this page. */
export function Asking() {
  const operator = useStore((state) => state.operator);
  const isDue = untilTakeOver(operator, useNow(true)) === 0;
  return html`
    <p role="status">${operator.holder ? `${nameOf(operator.holder)} is asked for control.` : "Control is free."}
      ${isDue ? " There was no answer: you may take over." : html` <${Left} words="You may take over" />`}</p>
    <div class="choice">
      <button class="chief" type="button" disabled=${!isDue} onClick=${() => takeControl({ note: operator.asking?.note })}>Take over</button>
      <button type="button" onClick=${release}>Cancel</button>
    </div>
  `;
}

/** Not announced again at every second. @param {{words: string}} props */
function Left({ words }) {
  const operator = useStore((state) => state.operator);
  const left_s = Math.ceil(untilTakeOver(operator, useNow(true)));
  return html`<span class="soft" aria-hidden="true">${words} ${left_s > 0 ? `in ${left_s} s` : "now"}.</span>`;
}
