/** What can be taken away of a run. */
import { html } from "../view.js";
import { DownloadMenu } from "./menu.js";

/** @type {[file: string, words: string, pictures?: boolean][]} pictures: made of them, where there are any */
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
  const frames = run.recording?.frames !== 0;
  const links = FILES.filter(([, , pictures]) => frames || !pictures)
    .map(([file, words]) => [`/api/v1/runs/${encodeURIComponent(run.id)}/${file}`, words]);
  return html`<${DownloadMenu} title="Download" links=${links} why=${why} remark=${frames ? "" : "No video: recorded without pictures."} />`;
}
