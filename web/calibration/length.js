/** A length that only the operator knows, in mm; what is typed and cannot be used counts as none. */
import { html, useId, useState } from "../view.js";

export function Length({ title, value, onChange, signed = false }) {
  const id = useId();
  const [text, setText] = useState(value === null ? "" : String(value));
  const known = readLength(text, signed);
  const type = (event) => {
    setText(event.target.value);
    onChange(readLength(event.target.value, signed));
  };
  return html`
    <div class="field">
      <label for=${id}>${title}</label>
      <span class="entry">
        <input id=${id} type="text" inputmode="decimal" autocomplete="off" value=${text} aria-invalid=${text !== "" && known === null} onInput=${type} />
        <span class="unit">mm</span>
      </span>
    </div>
  `;
}

/** The number of mm, null for what is none. */
function readLength(text, signed) {
  const value = Number(text.trim().replace("−", "-").replace(",", "."));
  const usable = text.trim() !== "" && Number.isFinite(value) && (signed || value > 0);
  return usable ? value : null;
}
