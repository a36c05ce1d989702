/** Who operates the rig, in words. Pure. */
import { quantity } from "../units.js";

/** @typedef {import("../types").Operator} Operator */
/** @typedef {{name: string, note?: string, kind?: string}} Somebody */

/** @param {Somebody} somebody */
export const nameOf = ({ name, kind }) => name || (kind === "script" ? "A script" : "Somebody");

/** @param {string} [note] what somebody says of why */
const quoted = (note) => (note ? `: “${note}”` : "");

/** @param {Operator} operator @returns {"you" | "nobody" | "other"} */
export const whoOperates = ({ holder, you }) => (holder === null ? "nobody" : holder.id === you ? "you" : "other");

/** @param {Operator} operator */
export const isAsking = ({ asking, you }) => asking !== null && asking.id === you;

/** How long the holder has not been heard of, s; 0 while that says nothing. @param {Operator} operator @param {number} now performance.now() */
export function silence({ holder, lease_s, heardAt }, now) {
  if (holder === null || holder.silent_s < lease_s) return 0;
  return holder.silent_s + (now - heardAt) / 1000;
}

/** And of why, or that nothing is heard of them. @param {Operator} operator @param {number} now @returns {[who: string, more: string, short: string]} short: in place of who */
export function standing(operator, now) {
  const { holder } = operator;
  if (holder === null) return ["Nobody operates", "", "Nobody"];
  const silent_s = silence(operator, now);
  const more = silent_s > 0 ? `silent for ${quantity(silent_s, "s", 0)}` : holder.note;
  return whoOperates(operator) === "you" ? ["You operate", more, "You"] : [`${nameOf(holder)} operates`, more, nameOf(holder)];
}

/** The same in one line: "Anna operates – calibrating", "Anna operates, silent for 5 s". @param {Operator} operator @param {number} now */
export function standingWords(operator, now) {
  const [who, more] = standing(operator, now);
  return more ? `${who}${silence(operator, now) > 0 ? "," : " –"} ${more}` : who;
}

/** Why this page may not command the rig just now, "" when it may: a free lease is taken by the first command. @param {Operator} operator */
export function obstacleIn(operator) {
  if (operator.you_may === "view") return "You may watch this rig, not operate it. STOP, pause and disarm work all the same.";
  const { holder } = operator;
  if (holder === null || whoOperates(operator) === "you") return "";
  return `${nameOf(holder)} operates. Ask for control in the bar; STOP, pause and disarm work all the same.`;
}

/** Until somebody who asks may take over, s. @param {Operator} operator @param {number} now */
export function untilTakeOver(operator, now) {
  const { asking, take_over_after_s, heardAt } = operator;
  if (asking === null || operator.holder === null || silence(operator, now) > 0) return 0;
  return Math.max(0, take_over_after_s - asking.since_s - (now - heardAt) / 1000);
}

/** @param {Somebody} asking */
export const questionWords = (asking) => `${asking.name || "Somebody"} asks for control${quoted(asking.note)}`;

/**
 * What has changed that this page did not do itself, "" when nothing has that concerns it.
 * @param {Operator} before
 * @param {Operator} after
 * @param {boolean} byHand this page has just given its lease away, or taken back its question
 */
export function newsOf(before, after, byHand) {
  const { holder } = after;
  if (byHand) return "";
  if (whoOperates(before) === "you" && holder === null) return "You no longer operate: this page was silent.";
  if (whoOperates(before) === "you" && holder !== null && holder.id !== after.you) return `${nameOf(holder)} has taken control${quoted(holder.note)}.`;
  if (!isAsking(before) || isAsking(after) || holder === null || holder.id === after.you) return "";
  return holder.id === before.holder?.id ? `${nameOf(holder)} keeps control.` : `${nameOf(holder)} operates now${quoted(holder.note)}.`;
}
