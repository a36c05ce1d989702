/** How to take control, to give it back, to ask for it. */
import { useStore } from "../store.js";
import { html, useEffect, useId, useState } from "../view.js";
import { loadOperator, release, rememberedName, takeControl } from "./lease.js";
import { Asking, useNow } from "./question.js";
import { isAsking, silence, standingWords, whoOperates } from "./words.js";

const ABOUT = "One page or script at a time commands the rig; everybody may watch, stop, pause and disarm.";

/** @param {{close: () => void}} props */
export function Panel({ close }) {
  const operator = useStore((state) => state.operator);
  const now = useNow(true);
  useEffect(() => void loadOperator(), []);
  return html`
    <section class="operator-panel" aria-label="Control of the rig">
      <p><b>${standingWords(operator, now)}.</b></p>
      <p class="hint">${ABOUT}</p>
      ${operator.you_may === "view" ? html`<p>You came in to watch: an operator’s token is needed for more.</p>`
        : isAsking(operator) ? html`<${Asking} />` : html`<${Wish} operator=${operator} isSilent=${silence(operator, now) > 0} close=${close} />`}
    </section>
  `;
}

/** @param {{operator: import("../types").Operator, isSilent: boolean, close: () => void}} props */
function Wish({ operator, isSilent, close }) {
  const who = whoOperates(operator);
  const [name, setName] = useState(rememberedName);
  const [note, setNote] = useState(() => (who === "you" ? operator.holder?.note ?? "" : ""));
  const send = (/** @type {Event} */ event) => {
    event.preventDefault();
    takeControl({ name: name.trim(), note: note.trim() });
    close();
  };
  const giveBack = () => {
    release();
    close();
  };
  return html`
    <form onSubmit=${send}>
      <${Words} title="Your name" hint="others see it" longest=${60} value=${name} put=${setName} />
      <${Words} title="What for" hint="calibrating" longest=${200} value=${note} put=${setNote} />
      <div class="choice">
        ${who === "you" && html`<button type="button" onClick=${giveBack}>Release control</button>`}
        <button class=${who === "you" ? "" : "chief"} type="submit">${LABELS[who === "other" && isSilent ? "silent" : who]}</button>
      </div>
    </form>
  `;
}

const LABELS = { you: "Save", nobody: "Take control", other: "Ask for control", silent: "Take over" };

/** @param {{title: string, hint: string, longest: number, value: string, put: (text: string) => void}} props longest: characters, as the server takes them */
function Words({ title, hint, longest, value, put }) {
  const id = useId();
  return html`
    <div class="field"><label for=${id}>${title}</label>
      <input id=${id} type="text" autocomplete="off" maxlength=${longest} placeholder=${hint} value=${value}
        onInput=${(/** @type {any} */ event) => put(event.target.value)} /></div>
  `;
}
