/** How somebody likes the charts, kept in this browser. */
import { keep, recalled } from "../memory.js";

const PLACE = "charts";
/** A phone shows one chart until somebody asks for more. */
const SMALL = "(max-width: 699px)";
const NARROW_FOLDED = ["Pose", "Currents", "Latency"];

/** What the page begins with. @returns {import("./span.js").View & {hidden: string[], folded: string[]}} */
export function rememberedView() {
  const narrow = globalThis.matchMedia?.(SMALL).matches ?? false;
  return { window_s: 60, held: null, zoom: null, hidden: [], folded: narrow ? NARROW_FOLDED : [], ...choices() };
}

/** @param {{window_s: number, folded: string[]}} view */
export function rememberView({ window_s, folded }) {
  keep(PLACE, { window_s, folded });
}

function choices() {
  const { window_s, folded } = recalled(PLACE) ?? {};
  const isList = Array.isArray(folded) && folded.every((title) => typeof title === "string");
  return { ...([10, 60, 600, 3600].includes(window_s) && { window_s }), ...(isList && { folded }) };
}
