/**
 * What the page knows, in one immutable object, and a hook that redraws a component when its part changes.
 * Everything that arrives at 30/s for canvases goes through `live/ticks.js` instead.
 */
import { rememberedView } from "./charts/remembered.js";
import { remembered } from "./scene/layers.js";
import { useEffect, useRef, useState } from "./view.js";

/** @typedef {import("./types").State} State */

/** @type {Set<() => void>} */
const listeners = new Set();

/** @type {State} */
let state = {
  /** status: "connecting" | "open" | "silent" (no telemetry for a moment) | "lost"; cause in words; retryAt:
      performance.now() of the next try, ms; late_ms: how much older than new what comes is. */
  connection: { status: "connecting", cause: "", retryAt: null, late_ms: 0 },
  /** Who operates (operator/lease.js): who this page is to the others, what it may, who commands, who asks for that. */
  operator: { you: "", you_may: "administer", holder: null, asking: null, lease_s: 2, take_over_after_s: 10, heardAt: 0 },
  /** Newest telemetry tick, a few times a second (for text). */
  tick: null,
  rig: null,
  camera: null,
  controllers: [],
  trajectories: [],
  gaitSchema: null,
  selection: null,
  /** Parts of the selection that somebody else has changed: taken over here, or kept since they were edited here. */
  elsewhere: null,
  /** The server has other files of the page than this one was made from. */
  outdated: false,
  passes: 1,
  /** Reference path of the selection: {points_mm, length_mm, duration_s} or null. */
  path: null,
  /** The same of the run that is going on, or null. */
  runPath: null,
  /** The run that is going on, as the server lists it, or null; what becomes of values sent to it, by "gait.tilt_deg". */
  walked: null,
  applying: {},
  /** What is said of the next run alone: {label, tags, unattended}. */
  nextRun: { label: "", tags: [], unattended: false },
  /** Text beside a field, by "controller.gain"-like keys: what the page refused, and what the server refused. */
  draftErrors: {},
  serverErrors: {},
  /** What a click into the camera picture does: "draw", "measure" or null (camera/tools.js). */
  tool: null,
  /** The path that is being drawn (draw/drawing.js); kept while its tool is put away. */
  drawing: null,
  /** What the camera's setup knows and does (calibration/setup.js), or null while it is closed. */
  setup: null,
  /** Recorded runs that are shown in place of the rig (replay/replay.js), or null: the rig itself is shown. */
  replay: null,
  /** The question before a real rig is armed is on the page. */
  consentAsked: false,
  /** Driving by hand (jog/jog.js): whether it is on, how fast, what is held down, why it has stopped. */
  jog: { on: false, rate_deg_s: 30, held: null, refusal: "" },
  /** Faults that can be put into a simulated rig (faults/catalogue.js), null on a real one and before the first answer. */
  faults: null,
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
  /** The help that is open: {of, name, title, at: the button's rectangle}, or null (help/popover.js). */
  help: null,
  /** The step of the tour that is shown, or null (tour/tour.js). */
  tour: null,
  /** The 3D scene of this page: layers that are shown; watching: its socket is open, null while that is not known;
      full_field_mT: end of the field's colours; follows: the view goes after the robot (scene/channel.js). */
  scene: { layers: remembered(), watching: null, full_field_mT: null, follows: false },
  /** The card that takes the whole page below the bar, or null (card/large.js). */
  large: null,
  /** What the charts of the rig show (charts/span.js): how far back, or which part stands still; which curves and charts not. */
  charts: rememberedView(),
  /** Which tab below the live part is open. */
  tab: "runs",
  /** What the tab of the rig knows and does (rig/settings.js), and how each calibration stands (calibration/standing.js). */
  rigPage: null,
  calibrations: null,
  /** Whether this browser tells of what happens while nobody looks (notify/device.js). */
  notify: { on: false, sound: false, permission: "default" },
  /** Lines of the event log, newest first; how far back they go, what of them is shown, the newest that was seen. */
  events: [],
  log: { next: null, loaded: false, loading: false, error: "", severity: "all", text: "", seen: 0 },
};

export const get = () => state;

/** @param {Partial<State>} change */
export function set(change) {
  state = { ...state, ...change };
  for (const listener of listeners) listener();
}

/**
 * Changes a part of what is held under one name; nothing while nothing is held there.
 * @template {keyof State} Name
 * @param {Name} name
 * @param {Partial<NonNullable<State[Name]>>} part
 */
export function amend(name, part) {
  const held = state[name];
  if (held !== null) set(/** @type {Partial<State>} */ ({ [name]: { .../** @type {any} */ (held), ...part } }));
}

/**
 * Redraws when `select(state)` changes (compared one level deep).
 * @template T
 * @param {(state: State) => T} select
 * @returns {T}
 */
export function useStore(select) {
  const [, redraw] = useState(0);
  const selected = select(state);
  // A selection may depend on what its component was drawn with: the newest one counts, against what is drawn.
  const drawn = useRef({ select, selected });
  drawn.current = { select, selected };
  useEffect(() => {
    const check = () => {
      if (!same(drawn.current.selected, drawn.current.select(state))) redraw((count) => count + 1);
    };
    listeners.add(check);
    check();
    return () => listeners.delete(check);
  }, []);
  return selected;
}

/** @param {any} a @param {any} b */
function same(a, b) {
  if (Object.is(a, b)) return true;
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => Object.is(a[key], b[key]));
}

let messageCount = 0;

/**
 * Shows a message until somebody dismisses it; the same words are shown once.
 * @param {string} text
 * @param {string} [severity]
 * @param {import("./types").Message["action"]} [action] what to do about it
 */
export function say(text, severity = "error", action = null) {
  if (state.messages.some((message) => message.text === text)) return;
  messageCount += 1;
  set({ messages: [...state.messages, { id: messageCount, text, severity, action }].slice(-3) });
}

/** @param {number} id */
export function dismiss(id) {
  set({ messages: state.messages.filter((message) => message.id !== id) });
}
