/** What the charts show while the rig itself is looked at: its last hour, up to now or standing still. */
import { live, onTick } from "../live/ticks.js";
import { agoSplits, agoWords, clockSplits, clockWords } from "./clock_axis.js";
import { hearGestures } from "./gestures.js";
import { drawMarks } from "./marks.js";
import { tellPointed } from "./pointed.js";
import { standsStill } from "./span.js";
import { onView, span, view } from "./view.js";

/** A chart is drawn at most this often: faster cannot be followed, ms... */
const REDRAW_MS = 100;
/** ...and at least this often, ms; between them, once for each half pixel that it moves. */
const SLOWEST_MS = 1000;
/** Numbers that change faster cannot be read, ms. */
const LEGEND_MS = 200;
/** A chart is about this wide, CSS px. */
const USUAL_WIDTH = 400;

const redrawPause = () => Math.min(SLOWEST_MS, Math.max(REDRAW_MS, (view().window_s * 1000) / USUAL_WIDTH / 2));

/** Hears of a tick, but not of the next ones for a while; of none while nobody looks. */
function onTickAtMost(pause, listener) {
  let told = 0;
  return onTick(() => {
    const now = performance.now();
    if (document.hidden || now - told < pause()) return;
    told = now;
    listener();
  });
}

const both = (one, other) => () => {
  one();
  other();
};

const widthOf = (plot) => plot.bbox.width / devicePixelRatio;
const namesOf = (curves) => curves.map(({ column }) => column);

/** @implements the source of `createChart` */
export const rigSource = {
  columns: (curves, pixels) => live.history.drawn(...span(), pixels, namesOf(curves)),
  range: () => span(),
  valuesAt: (_, pointed, curves) => live.history.valuesAt(pointed ?? span()[1], namesOf(curves)),
  /** What stands still is not drawn again. */
  onChange: (listener) => both(onTickAtMost(redrawPause, () => standsStill(view()) || listener()), onView(listener)),
  onTime: (listener) => both(onTickAtMost(() => LEGEND_MS, () => standsStill(view()) || listener()), onView(listener)),
  timeAxis: {
    splits: (plot) => (standsStill(view()) ? clockSplits(span(), live.clock_s, widthOf(plot)) : agoSplits(span(), widthOf(plot))),
    values: (plot) => (standsStill(view()) ? clockWords(span(), live.clock_s, widthOf(plot)) : agoWords(span(), widthOf(plot))),
  },
  attach(plot) {
    plot.hooks.draw = [drawMarks];
    plot.hooks.setCursor.push(tellPointed);
    return hearGestures(plot);
  },
};
