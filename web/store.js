/**
 * What the page knows, in one immutable object, and a hook that redraws a component when its part changes.
 * Everything that arrives at 30/s for canvases goes through `live/ticks.js` instead.
 */
import { useEffect, useState } from "./view.js";

const listeners = new Set();

let state = {
  /** status: "connecting" | "open" | "lost"; cause in words; retryAt: performance.now() of the next try, ms. */
  connection: { status: "connecting", cause: "", retryAt: null },
  /** Newest telemetry tick, a few times a second (for text). */
  tick: null,
  rig: null,
  camera: null,
  controllers: [],
  trajectories: [],
  gaitSchema: null,
  selection: null,
  passes: 1,
  /** Reference path of the selection: {points_mm, length_mm, duration_s} or null. */
  path: null,
  /** The same of the run that is going on, or null. */
  runPath: null,
  /** Text beside a field, by "controller.gain"-like keys: what the page refused, and what the server refused. */
  draftErrors: {},
  serverErrors: {},
  /** What the camera's setup knows and does (calibration/setup.js), or null while it is closed. */
  setup: null,
  /** Recorded runs that are shown in place of the rig (replay/replay.js), or null: the rig itself is shown. */
  replay: null,
  /** The question before a real rig is armed is on the page. */
  consentAsked: false,
  /** Name of the action under way, or null. */
  busy: null,
  messages: [],
  /** Runs as they are listed (runs/listing.js), null before the first answer, and the one whose details are open. */
  listing: null,
  inspected: null,
  /** Studies as they are listed, with the open one (studies/listing.js); the draft of a new one (studies/composing.js). */
  studies: null,
  composing: null,
  plants: [],
  /** Which tab below the live part is open. */
  tab: "runs",
  events: [],
};

export const get = () => state;

export function set(change) {
  state = { ...state, ...change };
  for (const listener of listeners) listener();
}

/** Redraws when `select(state)` changes (compared one level deep). */
export function useStore(select) {
  const [, redraw] = useState(0);
  const selected = select(state);
  useEffect(() => {
    let last = select(state);
    const check = () => {
      const next = select(state);
      if (!same(last, next)) redraw((count) => count + 1);
      last = next;
    };
    listeners.add(check);
    check();
    return () => listeners.delete(check);
  }, []);
  return selected;
}

function same(a, b) {
  if (Object.is(a, b)) return true;
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => Object.is(a[key], b[key]));
}

let messageCount = 0;

/** Shows a message until somebody dismisses it; the same words are shown once. */
export function say(text, severity = "error") {
  if (state.messages.some((message) => message.text === text)) return;
  messageCount += 1;
  set({ messages: [...state.messages, { id: messageCount, text, severity }].slice(-3) });
}

export function dismiss(id) {
  set({ messages: state.messages.filter((message) => message.id !== id) });
}
