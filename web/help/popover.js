/**
 * What a parameter means, beside its field: words, the paper's symbol and equation, a figure. It covers neither the bar
 * nor STOP; Escape is STOP and closes it too, and so does a click or the focus elsewhere.
 */
import { lazy } from "../journal/lazy.js";
import { useStore } from "../store.js";
import { html, useEffect, useLayoutEffect, useRef, useState } from "../view.js";
import { closeHelp } from "./button.js";
import { placeBeside } from "./placing.js";

export function HelpPopover() {
  const help = useStore((state) => state.help);
  return help && html`<${Popover} key=${`${help.of}.${help.name}`} ...${help} />`;
}

/** The help belongs to a field that is beside it. */
const FAR_PX = 24;

/** On a phone it is a sheet at the foot of the window. */
const SHEET = matchMedia("(max-width: 699px)");

const Contents = lazy(() => import("./contents.js").then((module) => module.Contents), "this help");

function Popover({ of, name, title, at }) {
  const box = useRef(null);
  const [place, setPlace] = useState(/** @type {any} */ ({}));
  useLayoutEffect(() => {
    const put = () => setPlace(placeOf(box.current, at));
    const sizes = new ResizeObserver(put);
    sizes.observe(box.current);
    put();
    return () => sizes.disconnect();
  }, []);
  useDismissal(box);
  return html`
    <div class="help" role="dialog" aria-label=${title} tabindex="-1" ref=${box} style=${place}>
      <div class="help-head"><h3>${title}</h3><button class="quiet" type="button" onClick=${closeHelp}>Close</button></div>
      <${Contents} of=${of} name=${name} />
    </div>
  `;
}

function placeOf(box, at) {
  if (SHEET.matches) return {};
  const bar = document.querySelector(".bar")?.getBoundingClientRect().bottom ?? 0;
  const size = { width: box.offsetWidth, height: box.offsetHeight };
  const { left, top } = placeBeside(at, size, { width: innerWidth, height: innerHeight, top: bar });
  return { left: `${left}px`, top: `${top}px` };
}

/** The focus comes in, and goes back to the button when the help closes while it is inside. */
function useDismissal(box) {
  useEffect(() => {
    const from = document.activeElement;
    const own = box.current;
    own.focus({ preventScroll: true });
    const isOutside = (event) => !own.contains(event.target) && !(event.type === "pointerdown" && event.target === from);
    const leave = (event) => isOutside(event) && closeHelp();
    const press = (event) => event.key === "Escape" && closeHelp();
    const place = from?.getBoundingClientRect().top ?? 0;
    // Its field has gone elsewhere; a scroll that ends just as it opens does not move it.
    const moved = () => Math.abs((from?.getBoundingClientRect().top ?? 0) - place) > FAR_PX && closeHelp();
    addEventListener("pointerdown", leave, true);
    addEventListener("focusin", leave);
    addEventListener("keydown", press, true);
    addEventListener("scroll", moved, true);
    addEventListener("resize", closeHelp);
    return () => {
      const inside = own.contains(document.activeElement) || document.activeElement === document.body;
      removeEventListener("pointerdown", leave, true);
      removeEventListener("focusin", leave);
      removeEventListener("keydown", press, true);
      removeEventListener("scroll", moved, true);
      removeEventListener("resize", closeHelp);
      if (inside && from instanceof HTMLElement && from.isConnected) from.focus({ preventScroll: true });
    };
  }, []);
}
