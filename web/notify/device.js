/** This browser tells of a fault and of what has ended, while its page is hidden or another window has the focus. */
import { showTab } from "../journal/tab.js";
import * as memory from "../memory.js";
import { get, say, set } from "../store.js";
import { beep } from "./sound.js";
import { worthTelling } from "./worth.js";

const KEPT = "notify";

/** "granted", "denied", "default" (not asked yet), or "missing": this browser cannot, or not over plain HTTP. */
const permission = () => ("Notification" in globalThis && isSecureContext ? Notification.permission : "missing");

/** What was chosen at an earlier visit. */
export function recall() {
  set({ notify: { ...kept(), permission: permission() } });
}

function kept() {
  const { on, sound } = memory.recalled(KEPT) ?? {};
  return { on: on === true, sound: sound === true };
}

function keep(change) {
  const notify = { ...get().notify, ...change, permission: permission() };
  set({ notify });
  memory.keep(KEPT, { on: notify.on, sound: notify.sound });
}

/** Asks the person through the browser; only ever by a click. */
export async function turnOn() {
  const answer = permission() === "default" ? await Notification.requestPermission() : permission();
  keep({ on: answer === "granted" });
}

export const turnOff = () => keep({ on: false });

export function setSound(sound) {
  keep({ sound });
  if (sound) beep();
}

const isAway = () => document.hidden || !document.hasFocus();

/** @param {any} message of the telemetry stream */
export function tellIfAway(message) {
  const { on, sound } = get().notify;
  if (!(on || sound) || !isAway()) return;
  const told = worthTelling(message);
  if (told === null) return;
  if (on) show(told);
  if (sound) beep();
}

/** To see what it looks like. */
export const tryOut = () => show({ title: "A test", text: "This is how the rig tells you.", tag: "test", tab: "" });

function show({ title, text, tag, tab }) {
  const rig = get().rig?.name ?? "pivotrig";
  try {
    const shown = new Notification(`${title} – ${rig}`, { body: text, tag, icon: "/static/icon.svg" });
    shown.onclick = () => {
      focus();
      if (tab) showTab(tab);
      shown.close();
    };
  } catch (problem) {
    // On Android a page may ask for the permission, but not show anything.
    keep({ on: false });
    say(`This browser cannot show notifications (${problem instanceof Error ? problem.message : "it refuses"}); a webhook can reach a phone.`);
  }
}
