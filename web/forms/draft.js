/** What is typed into a field until it can be used, and the texts about it that stand beside the field. */
import { get, set } from "../store.js";
import { useState } from "../view.js";
import { parse, show } from "./schema.js";

/** @typedef {import("./schema.js").Form} Form */

/** @param {string} id @param {string} text "" when nothing is wrong any more */
export function setDraftError(id, text) {
  const { [id]: before, ...others } = get().draftErrors;
  if ((before ?? "") === text) return;
  set({ draftErrors: text ? { ...others, [id]: text } : others });
}

/** Lets go of everything typed into a section that could not be used: "gait". @param {string} section */
export function forgetDrafts(section) {
  const kept = Object.entries(get().draftErrors).filter(([id]) => !id.startsWith(`${section}.`));
  set({ draftErrors: Object.fromEntries(kept) });
}

/**
 * What is typed, while it is the newest: until the value is changed from elsewhere, or somebody takes the refusal back.
 * @param {{form: Form, value: any, onChange: (value: any) => void, refuse: (text: string) => void, refused: boolean}} props
 */
export function useDraft({ form, value, onChange, refuse, refused }) {
  const [draft, setDraft] = useState(null);
  const type = (text) => {
    const { value: next, error } = parse(text, form);
    setDraft({ text, usable: !error, value: next });
    refuse(error ?? "");
    if (!error) onChange(next);
  };
  const settle = () => {
    if (draft?.usable) setDraft(null);
  };
  /** A value that needs no reading, from a step or a slider. */
  const put = (next) => {
    setDraft(null);
    refuse("");
    onChange(next);
  };
  const newest = draft !== null && (draft.usable ? same(draft.value, value) : refused);
  return { text: newest ? draft.text : show(value, form), type, settle, put };
}

const same = (a, b) => a === b || JSON.stringify(a) === JSON.stringify(b);
