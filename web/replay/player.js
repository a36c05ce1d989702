/** The clock of a replay: what time of the recording is shown, and how it goes on. */
import { amend, get } from "../store.js";
import { useEffect, useState } from "../view.js";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];
/** Text follows at this pace: faster cannot be read, ms. */
const TEXT_MS = 125;
/** After a longer pause of the browser (a hidden tab, a sleeping computer) the replay goes on where it was, ms. */
const LONGEST_BEAT_MS = 250;
/** A step where nobody has counted the pictures, s. */
const STEP = 0.1;
/** Shorter ranges are slips of the hand, s. */
const SHORTEST_RANGE = 0.05;

let time = 0;
let beatAt = 0;
let beating = 0;
/** While somebody holds the scrubber the time is theirs. */
let held = false;
/** Says whether the recording is not read as fast as it is played. */
let isBehind = () => false;
const listeners = new Set();

/** Seconds since the start of the run. */
export const now_s = () => time;

/** Hears of each new time, up to once a drawn frame. */
export function onTime(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** @param {Partial<import("../types").Replay>} part */
const change = (part) => amend("replay", part);
const tell = () => listeners.forEach((listener) => listener(time));
const duration = () => get().replay?.duration_s ?? 0;

export function restart() {
  time = 0;
  tell();
}

/** Shows another time; outside the loop the loop ends to hold. */
export function seek(to) {
  const { replay } = get();
  if (!replay || !Number.isFinite(to)) return;
  time = Math.min(Math.max(0, to), duration());
  if (replay.loop && !(replay.loop[0] <= time && time <= replay.loop[1])) change({ loop: null });
  tell();
}

export const seekBy = (seconds) => seek(time + seconds);

export function play() {
  const { replay } = get();
  if (!replay || replay.playing || !(duration() > 0)) return;
  if (time >= duration()) restart();
  change({ playing: true });
  beatAt = performance.now();
  cancelAnimationFrame(beating);
  beating = requestAnimationFrame(beat);
}

export function pause() {
  cancelAnimationFrame(beating);
  if (get().replay?.playing) change({ playing: false });
}

export const toggle = () => (get().replay?.playing ? pause() : play());

/** One picture on or back, or one tick of the rig's loop where there are no pictures; stands still afterwards. */
export function step(direction) {
  const run = get().replay?.runs[0];
  if (!run) return;
  pause();
  seek(time + direction * stepLength(run));
}

function stepLength({ frames, ticks, duration_s }) {
  const count = frames || ticks;
  return count > 0 ? duration_s / count : STEP;
}

export const setSpeed = (speed) => change({ speed });
export const hold = () => void (held = true);
export const letGo = () => void (held = false);

/** The clock waits while `behind()`: it shall not run away from what is shown. */
export const waitWhile = (behind) => void (isBehind = behind);

function beat(at) {
  const { replay } = get();
  if (!replay?.playing) return;
  const passed = Math.min(at - beatAt, LONGEST_BEAT_MS) / 1000;
  beatAt = at;
  if (!held && !isBehind() && passed > 0) advance(passed * replay.speed, replay);
  if (get().replay?.playing) beating = requestAnimationFrame(beat);
}

function advance(seconds, { loop }) {
  time += seconds;
  const [start, end] = loop ?? [0, duration()];
  if (time >= end) {
    time = loop ? start : end;
    if (!loop) pause();
  }
  tell();
}

/** The range that is played again and again begins, or ends, here. */
export function loopFromHere() {
  const [, end] = get().replay?.loop ?? [0, duration()];
  setLoop(time, end > time ? end : duration());
}

export function loopToHere() {
  const [start] = get().replay?.loop ?? [0];
  setLoop(start < time ? start : 0, time);
}

export function setLoop(from, to) {
  if (!(to - from >= SHORTEST_RANGE)) return;
  change({ loop: [from, to] });
  if (!(from <= time && time <= to)) seek(from);
}

export const endLoop = () => change({ loop: null });

/** The charts show this range alone. */
export function zoomTo(from, to) {
  /** @type {[number, number]} */
  const range = [Math.max(0, from), Math.min(duration(), to)];
  if (range[1] - range[0] >= SHORTEST_RANGE) change({ zoom: range, closer: null });
}

export const zoomOut = () => change({ zoom: null, closer: null });

/** Hears at the pace of text what `subscribe` tells faster, and always of the last. */
export const atTextPace = (subscribe) => (listener) => {
  let timer = 0;
  const forget = subscribe(() => {
    timer ||= setTimeout(() => {
      timer = 0;
      listener();
    }, TEXT_MS);
  });
  return () => {
    clearTimeout(timer);
    forget();
  };
};

export const onTextTime = atTextPace(onTime);

/** The time for text, s. */
export function useTime() {
  const [shown, show] = useState(time);
  useEffect(() => onTextTime(() => show(time)), []);
  return shown;
}
