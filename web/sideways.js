/** What is wider than its place scrolls sideways, and its edge shows that there is more. */
import { html, useEffect, useRef, useState } from "./view.js";

/** Rounding is no more to see, px. */
const SLACK = 2;

/** @param {{name: string, children: any}} props name: class of the place */
export function Sideways({ name, children }) {
  const place = useRef(null);
  const [more, setMore] = useState("none");
  useEffect(() => {
    const own = place.current;
    const look = () => {
      const [before, after] = [own.scrollLeft > SLACK, own.scrollLeft + own.clientWidth < own.scrollWidth - SLACK];
      setMore(before && after ? "both" : before ? "before" : after ? "after" : "none");
    };
    const sizes = new ResizeObserver(look);
    for (const element of [own, ...own.children]) sizes.observe(element);
    own.addEventListener("scroll", look, { passive: true });
    return () => {
      sizes.disconnect();
      own.removeEventListener("scroll", look);
    };
  }, []);
  // Only what scrolls can be scrolled with the keyboard.
  return html`
    <div class="sideways" data-more=${more}>
      <div class=${name} ref=${place} tabindex=${more === "none" ? undefined : 0}>${children}</div>
    </div>
  `;
}
