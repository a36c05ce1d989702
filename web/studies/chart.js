/** What the figures of a study share: a box that is as wide as its place, ticks, and places in pixels. */
import { useLayoutEffect, useRef, useState } from "../view.js";

const NARROWEST = 220;

/** @returns {[{current: any}, number]} ref of the element to measure, its width in px */
export function useWidth(first = 420) {
  const place = useRef(null);
  const [width, setWidth] = useState(first);
  useLayoutEffect(() => {
    const measure = () => place.current && setWidth(Math.max(NARROWEST, Math.floor(place.current.clientWidth)));
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(place.current);
    return () => observer.disconnect();
  }, []);
  return [place, width];
}

const STEPS = [1, 2, 2.5, 5, 10];

/** Round numbers from the first at or above low to the last at or below high. */
export function ticksOf(low, high, count = 4) {
  if (!(high > low)) return [low];
  const raw = (high - low) / count;
  const size = 10 ** Math.floor(Math.log10(raw));
  const step = (STEPS.find((each) => each * size >= raw) ?? 10) * size;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => Number(((first + index) * step).toPrecision(12)));
}

/**
 * From a range of values to a range of pixels.
 * @param {number[]} values from, to
 * @param {number[]} places start, end
 * @returns {(value: number) => number}
 */
export const linear = ([from, to], [start, end]) => (value) => (to > from ? start + ((value - from) / (to - from)) * (end - start) : (start + end) / 2);

/** A range with some room at both ends. */
export function padded(low, high, share = 0.06) {
  const room = high > low ? (high - low) * share : Math.abs(high) * share || 1;
  return [low - room, high + room];
}
