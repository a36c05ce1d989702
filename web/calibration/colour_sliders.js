/** The thresholds of a colour, by hand; the mask in the picture follows. */
import { html, useId } from "../view.js";

const CHANNELS = [
  { name: "hue_deg", title: "Hue", most: 360, sign: "°", wraps: true },
  { name: "saturation", title: "Saturation", most: 255, sign: "" },
  { name: "value", title: "Brightness", most: 255, sign: "" },
];

export function Sliders({ colour, onChange }) {
  return html`
    <details class="more">
      <summary>Adjust by hand</summary>
      <div class="sliders">
        ${CHANNELS.map((channel) => html`
          <${Channel} key=${channel.name} ...${channel} span=${colour[channel.name]}
            onChange=${(span) => onChange({ ...colour, [channel.name]: span })} />
        `)}
      </div>
      <p class="hint">A hue that begins above where it ends goes through red.</p>
    </details>
  `;
}

/** Low and high end. But for the hue, which is a circle, pushing one end past the other takes that along. */
function Channel({ name, title, most, sign, wraps, span, onChange }) {
  const set = (index, value) => {
    const next = span.map((end, other) => {
      if (other === index) return value;
      return wraps ? end : other < index ? Math.min(end, value) : Math.max(end, value);
    });
    onChange(next);
  };
  return html`
    <fieldset class="channel">
      <legend>${title} <span class="soft">${Math.round(span[0])}${sign} to ${Math.round(span[1])}${sign}</span></legend>
      <span class="scale" data-scale=${name} aria-hidden="true"></span>
      ${["from", "to"].map((word, index) => html`
        <${End} label=${`${title} ${word}`} word=${word} most=${most} value=${span[index]} onChange=${(value) => set(index, value)} />
      `)}
    </fieldset>
  `;
}

function End({ label, word, most, value, onChange }) {
  const id = useId();
  return html`
    <label for=${id} class="soft" aria-hidden="true">${word}</label>
    <input id=${id} type="range" min="0" max=${most} step="1" aria-label=${label} value=${value}
      onInput=${(event) => onChange(Number(event.target.value))} />
  `;
}
