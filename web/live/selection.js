/** Controller, trajectory and gait of the next run: on the page at once, on the rig when typing pauses. */
import { get, set } from "../store.js";
import { isSame, merge } from "./merging.js";
import { question, subject } from "./order.js";
import { PAGE_ID } from "./page_id.js";
import { put } from "./rest.js";

const EDIT_PAUSE_MS = 300;

/** @typedef {import("../types").Selection} Selection */

/** What the rig has, as far as is known. @type {Selection | null} */
let known = null;
const selections = subject();
let edited = false;
let timer = 0;
let refused = /** @type {(problem: unknown) => void} */ ((problem) => { throw problem; });

/** @param {(problem: unknown) => void} listener hears why an edit was refused */
export function onRefusedEdit(listener) {
  refused = listener;
}

/** @param {Partial<Selection>} change */
export function select(change) {
  const { selection } = get();
  if (!selection) return;
  set({ selection: { ...selection, ...change }, serverErrors: {}, elsewhere: null });
  edited = true;
  sendLater();
}

function sendLater() {
  clearTimeout(timer);
  timer = setTimeout(() => sendSelection().catch(refused), EDIT_PAUSE_MS);
}

/** What is on the page goes to the rig now. */
export async function sendSelection() {
  clearTimeout(timer);
  const sent = get().selection;
  if (!edited || !sent) return;
  known = await put(`/selection?by=${PAGE_ID}`, sent);
  question(selections);
  edited = get().selection !== sent;
  set({ serverErrors: {} });
  if (edited) sendLater();
}

/** Whether, since then, the page has been told nothing and has sent nothing. @returns {() => boolean} */
export const askForSelection = () => question(selections);

/** The rig's own, after a connection: what was not sent before it broke is gone. @param {Selection} selection @returns {boolean} something was */
export function adoptSelection(selection) {
  const unsent = edited && known !== null && !isSame(get().selection, selection);
  clearTimeout(timer);
  edited = false;
  known = selection;
  set({ selection, elsewhere: null });
  return unsent;
}

/** Somebody has chosen: this page, another one or a script. @param {Selection} selection @param {string} [by] */
export function hearOfSelection(selection, by) {
  question(selections);
  const mine = get().selection;
  const base = known;
  known = selection;
  if (by === PAGE_ID || !mine || !base) return edited || isSame(mine, selection) ? undefined : set({ selection });
  const { merged, taken, kept } = edited ? merge(base, mine, selection) : merge(mine, mine, selection);
  if (taken.length + kept.length > 0) set({ selection: merged, elsewhere: { taken, kept } });
}
