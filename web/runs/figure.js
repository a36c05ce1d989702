/** The paper's figure of a run. The server draws it, so it is asked for once somebody stays with the run. */
import { html, useEffect, useState } from "../view.js";
import { nameOf, whyNothingToReplay } from "./words.js";

const STAYS_MS = 250;

export function Figure({ run }) {
  const there = whyNothingToReplay(run) === "";
  const [wanted, want] = useState(false);
  const [standing, stand] = useState("drawing");
  useEffect(() => {
    const timer = setTimeout(() => want(true), STAYS_MS);
    return () => clearTimeout(timer);
  }, []);
  if (!there) return null;
  const address = `/api/v1/runs/${encodeURIComponent(run.id)}/plot.png`;
  const words = { drawing: "Drawing the figure…", failed: "The figure could not be drawn." }[standing];
  return html`
    <figure class="run-figure" data-standing=${standing}>
      ${words && html`<p class="hint">${words}</p>`}
      ${wanted && standing !== "failed" && html`
        <a href=${address} target="_blank" title="Open the figure by itself">
          <img src=${address} alt=${`Path, error over time and distribution of the error of ${nameOf(run)}`} onLoad=${() => stand("drawn")} onError=${() => stand("failed")} />
        </a>`}
    </figure>
  `;
}
