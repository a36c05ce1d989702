/**
 * What a click into the camera picture means just now, and what else is drawn there. Whoever needs a place in the
 * picture takes the pointer and gives it back; of several the one that took it last has it.
 */
import { useEffect, useRef, useState } from "../view.js";

/**
 * @typedef {{u: number, v: number, pixel: number, touch?: boolean}} Place in camera pixels; pixel: a CSS pixel in
 *   them; touch: a finger points at it
 * @typedef {{
 *   words: string, press: (place: Place) => unknown, move?: (place: Place) => void, release?: () => void,
 *   cancel?: () => void, hover?: (place: Place | null) => void, again?: (place: Place) => void,
 *   key?: (event: KeyboardEvent, place: Place) => boolean,
 * }} Taker press: one that answers true has taken hold of something, which follows the keys until Enter lets it go;
 *   cancel: two fingers move the picture, so what the first one began was not meant; again: a double click; key: a key
 *   at the crosshair that is no arrow, answers whether it meant something
 */
/** @type {(() => Taker | null)[]} */
const takers = [];
/** What a layer answers that does not want the overlay over it. */
export const ALONE = "alone";
/** draw({context, pixel, picture, size, project}), over the picture and under the overlay. */
const layers = new Set();
const listeners = new Set();

const changed = () => listeners.forEach((listener) => listener());

/** Hears of a new taker or layer, and of a layer that wants to be drawn again. */
export function onPointingChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export const drawnLayers = () => layers;
export const redraw = changed;

/** Takes the pointer while `taker` is not null. behind: gives way to every other taker. */
export function usePointer(taker, { behind = false } = {}) {
  const newest = useRef(taker);
  newest.current = taker;
  const wanted = taker !== null;
  useEffect(() => {
    if (!wanted) return undefined;
    const own = () => newest.current;
    if (behind) takers.unshift(own);
    else takers.push(own);
    changed();
    return () => {
      takers.splice(takers.indexOf(own), 1);
      changed();
    };
  }, [wanted, behind]);
  useEffect(changed, [taker?.words]);
}

/** Draws over the picture while the component is there; `what` is everything that the drawing depends on. */
export function useLayer(draw, what) {
  const newest = useRef(draw);
  newest.current = draw;
  useEffect(() => {
    const own = (pen) => newest.current(pen);
    layers.add(own);
    return () => {
      layers.delete(own);
      changed();
    };
  }, []);
  useEffect(changed, what);
}

/** Redraws the component when the pointer changes hands. */
export function useTaker() {
  const [, count] = useState(0);
  useEffect(() => onPointingChange(() => count((before) => before + 1)), []);
  return takers.at(-1)?.() ?? null;
}
