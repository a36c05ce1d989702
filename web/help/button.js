/** The small `?` beside a parameter: opens what it means, with a figure, beside the field. */
import { get, set, useStore } from "../store.js";
import { html } from "../view.js";

/** What the help knows, by the first word of whose parameter it is. */
const KNOWN = ["gait", "controller", "trajectory", "run", "metrics"];

/** @param {{of: string, form: {name: string, title: string, description?: string}}} props of: "gait", "controller.geometric", … */
export function HelpButton({ of, form: { name, title } }) {
  const open = useStore(({ help }) => help?.of === of && help?.name === name);
  if (!KNOWN.includes(of.split(".")[0])) return null;
  const press = (event) => {
    set({ help: open ? null : { of, name, title, at: besides(event.currentTarget) } });
  };
  return html`<button class="help-button" type="button" aria-haspopup="dialog" aria-expanded=${open} aria-label=${`What is ${inSentence(title)}?`} onClick=${press}>?</button>`;
}

/** As high as the field and as wide as the panel that it stands in, so that the help covers neither. */
function besides(button) {
  const { top, bottom } = (button.closest(".field, dt") ?? button).getBoundingClientRect();
  const { left, right } = (button.closest(".run, .run-details, dialog") ?? button).getBoundingClientRect();
  return { left, top, right, bottom };
}

/** "Sweep" inside a sentence is "sweep", "ME" and "RMS error" stay as they are. */
const inSentence = (title) => (/^[A-Z]{2}/.test(title) ? title : title[0].toLowerCase() + title.slice(1));

/** Closes the help; the focus goes back to where it was opened when it is still inside. */
export function closeHelp() {
  if (get().help !== null) set({ help: null });
}
