/** In the bar: whether what happens now is being recorded, and in red words when it is not although it should be. */
import { useStore } from "../store.js";
import { fixed } from "../units.js";
import { html } from "../view.js";
import { bytes } from "./words.js";

export function RecordingSign({ recording }) {
  const rate = useStore((state) => state.rig?.recording?.frames_Hz);
  if (recording?.state === "failed") {
    return html`<span class="recording-sign" data-state="failed" role="alert" title=${recording.failure}>Not recorded: ${recording.failure}</span>`;
  }
  if (recording?.state !== "recording") return null;
  const pictures = rate > 0 ? `${fixed(rate, 0)} fps` : "no pictures";
  return html`
    <span class="recording-sign" data-state="recording" title=${detail(recording)}>
      <span class="dot" aria-hidden="true">●</span> REC <span class="soft">${pictures} · ${bytes(recording.size_bytes)}</span>
    </span>
  `;
}

function detail({ run, frames_left_out: left, ticks_waiting: waiting }) {
  const missing = left > 0 ? `; ${left} pictures left out because the computer was busy` : "";
  return `Run ${run ?? ""} is being recorded; ${waiting ?? 0} ticks wait to be written${missing}`;
}
