/** What has the keyboard just now: a text that is typed, a list to choose from, a question that waits. */

const TEXT_INPUTS =
  "textarea, [contenteditable=true], input:not([type=checkbox]):not([type=radio]):not([type=button]):not([type=range])";

/** Also for what a browser itself puts into a field, which comes as a key without a name or a window. @param {any} event */
export const isTyping = (event) => event.target?.matches?.(TEXT_INPUTS) ?? false;

/** A question covers the page; only STOP goes through it. */
export const isAsked = () => document.querySelector("dialog[open]") !== null;

/** Keys of the page are not for it now. @param {any} event */
export const isTaken = (event) => isTyping(event) || (event.target?.matches?.("select") ?? false) || isAsked();
