/** What can be taken away of a run: plain links, so that the browser shows how far it is. */
import { html, useEffect, useRef } from "../view.js";

/** [file, words, needs pictures] */
const FILES = [
  ["samples.csv", "Table, CSV"],
  ["samples.parquet", "Table, Parquet"],
  ["samples.mat", "Table, MATLAB"],
  ["recording.mcap", "Recording, MCAP (Foxglove)"],
  ["plot.png", "Figure, PNG"],
  ["plot.svg", "Figure, SVG"],
  ["video.mp4?overlay=true", "Video with overlay, MP4", true],
  ["video.mp4?overlay=false", "Video, MP4", true],
];

export function Downloads({ run, why }) {
  const menu = useRef(null);
  useCloseOutside(menu);
  if (why) return html`<button type="button" disabled title=${why}>Download</button>`;
  const frames = run.recording?.frames !== 0;
  const close = () => (menu.current.open = false);
  return html`
    <details class="menu" ref=${menu}>
      <summary>Download</summary>
      <ul>
        ${FILES.filter(([, , pictures]) => frames || !pictures).map(([file, words]) => html`
          <li key=${file}><a href=${`/api/v1/runs/${encodeURIComponent(run.id)}/${file}`} download onClick=${close}>${words}</a></li>
        `)}
        ${!frames && html`<li class="hint">No video: recorded without pictures.</li>`}
      </ul>
    </details>
  `;
}

/** A click or the focus elsewhere closes it. */
function useCloseOutside(menu) {
  useEffect(() => {
    const leave = (event) => menu.current && !menu.current.contains(event.target) && (menu.current.open = false);
    addEventListener("pointerdown", leave);
    addEventListener("focusin", leave);
    return () => {
      removeEventListener("pointerdown", leave);
      removeEventListener("focusin", leave);
    };
  }, []);
}
