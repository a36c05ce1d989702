/**
 * Three steps for somebody who is here for the first time. It points at the real things and never stands before them:
 * every button stays in use, and doing what a step tells moves it on.
 */
import { placeBeside } from "../help/placing.js";
import { get, set, useStore } from "../store.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { isSeen, remember } from "./memory.js";
import { LAST, stepAfter, STEPS } from "./steps.js";

function end() {
  remember();
  set({ tour: null });
}

const go = (step) => (step === null ? end() : set({ tour: step }));

export function Tour() {
  const step = useStore((state) => state.tour);
  const rig = useStore((state) => state.tick?.rig);
  const elsewhere = useStore((state) => state.setup !== null || state.replay !== null || state.consentAsked || state.connection.status === "lost");
  const before = useRef(rig);
  useEffect(() => {
    // Somebody who comes to a rig at work looks for it, not for a tour.
    if (before.current === undefined && rig === "disarmed" && !isSeen()) set({ tour: 0 });
    const { tour } = get();
    const next = tour === null ? null : stepAfter(tour, before.current, rig);
    if (next !== tour) go(next);
    before.current = rig;
  }, [rig]);
  if (step === null || elsewhere) return null;
  return html`<${Card} key=${step} step=${step} />`;
}

function Card({ step }) {
  const { title, words, target } = STEPS[step];
  const card = useRef(null);
  const place = usePlace(target, card);
  const last = step === LAST;
  useEffect(() => {
    const there = document.querySelector(target);
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (there && step > 0 && isOutOfView(there)) there.scrollIntoView({ block: "center", behavior: still ? "auto" : "smooth" });
  }, []);
  return html`
    ${place && html`<div class="tour-ring" aria-hidden="true" style=${px(place.ring)}></div>`}
    <aside class="tour" role="region" aria-label="Tour" ref=${card} data-side=${place?.side} style=${place ? px(place) : { visibility: "hidden" }}>
      <p class="tour-count">${step + 1} of ${STEPS.length}</p>
      <h3>${title}</h3>
      <p>${words}</p>
      <div class="tour-buttons">
        <button class="next" type="button" onClick=${() => go(last ? null : step + 1)}>${last ? "Done" : "Next"}</button>
        ${!last && html`<button class="quiet" type="button" onClick=${end}>Skip the tour</button>`}
      </div>
    </aside>
  `;
}

const px = ({ left, top, width, height }) => ({
  left: `${left}px`, top: `${top}px`, ...(width ? { width: `${width}px`, height: `${height}px` } : {}),
});

const isOutOfView = (element) => {
  const { top, bottom } = element.getBoundingClientRect();
  return top < 0 || bottom > innerHeight;
};

/** What the card never covers. */
const CLEAR = ".bar, .run .actions, .run .jog";
const RING_PX = 4;

/** Follows its target at a calm pace; null while there is none to be seen. */
function usePlace(target, card) {
  const [place, setPlace] = useState(/** @type {any} */ (null));
  useEffect(() => {
    const look = () => setPlace((before) => kept(before, placed(target, card.current)));
    look();
    const timer = setInterval(look, 250);
    addEventListener("scroll", look, { capture: true, passive: true });
    addEventListener("resize", look);
    return () => {
      clearInterval(timer);
      removeEventListener("scroll", look, true);
      removeEventListener("resize", look);
    };
  }, [target]);
  return place;
}

const kept = (before, next) => (JSON.stringify(before) === JSON.stringify(next) ? before : next);

function placed(target, card) {
  const there = document.querySelector(target);
  if (!there || !card || there.getClientRects().length === 0) return null;
  const rect = there.getBoundingClientRect();
  const bar = document.querySelector(".bar")?.getBoundingClientRect();
  const clear = [...document.querySelectorAll(CLEAR)].map((element) => element.getBoundingClientRect());
  const size = { width: card.offsetWidth, height: card.offsetHeight };
  const { left, top, side } = placeBeside(rect, size, { width: innerWidth, height: innerHeight, top: bar?.bottom ?? 0 }, clear, 14);
  const ring = { left: rect.left - RING_PX, top: rect.top - RING_PX, width: rect.width + 2 * RING_PX, height: rect.height + 2 * RING_PX };
  return { left, top, side, ring };
}
