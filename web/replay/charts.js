/** The charts while a recording is shown: the whole run or a part of it, with the time of the replay in each. */
import { Chart } from "../charts/charts.js";
import { CHARTS } from "../charts/curves.js";
import { html, useEffect, useMemo } from "../view.js";
import { lookCloser } from "./closer.js";
import { setLoop, zoomOut } from "./player.js";
import { useReplay } from "./replay.js";
import { Badge, Line, stamp } from "./signs.js";
import { wholeRun } from "./timeline.js";

/** What a recording has, too. */
const RECORDED = CHARTS.filter(({ liveOnly }) => !liveOnly);

export function ReplayCharts() {
  const recorded = useReplay((replay) => replay.runs) ?? [];
  const again = useReplay((replay) => replay.second?.series) ?? null;
  const runs = useMemo(() => (again ? [...recorded, seenAgain(recorded[0], again)] : recorded), [recorded, again]);
  const zoom = useReplay((replay) => replay.zoom);
  const closer = useReplay((replay) => replay.closer);
  const source = useMemo(() => wholeRun(runs), [runs]);
  const charts = useMemo(() => (runs.length > 1 ? RECORDED.map(compared) : RECORDED), [runs.length > 1]);
  useEffect(source.changed, [zoom, closer]);
  useEffect(() => void lookCloser(), [zoom]);
  if (runs.length === 0) return html`<section class="charts" aria-label="Charts of the recording"></section>`;
  return html`
    <section class="charts" aria-label="Charts of the recording">
      <${Range} zoom=${zoom} runs=${runs} />
      ${charts.map((chart) => html`
        <${Chart} key=${chart.title} ...${chart} empty="Nothing was recorded of this." source=${source} span="of the recording" />
      `)}
    </section>
  `;
}

/** The second look at a run, as a run of its own beside it. */
const seenAgain = (run, series) => ({ id: "again", name: `${run.name}, seen again`, series });

/** What is shown, and how to get from a part to the whole. */
function Range({ zoom, runs }) {
  return html`
    <div class="charts-range">
      <${Badge} />
      ${runs.length > 1 && runs.map((run, index) => html`<span><${Line} index=${index} />${run.name}</span>`)}
      ${zoom === null
        ? html`<span class="hint">click: go there · drag: a closer look</span>`
        : html`
          <span class="hint">${stamp(zoom[0])} – ${stamp(zoom[1])}</span>
          <button class="quiet" type="button" onClick=${() => setLoop(...zoom)}>Loop this part</button>
          <button class="quiet" type="button" onClick=${zoomOut}>Whole run</button>`}
    </div>
  `;
}

/** Two runs in one chart: the estimates of both, the second's dashed; the rest would be too much to read. */
function compared(chart) {
  const estimates = chart.curves.filter(({ label }) => label);
  const curves = estimates.flatMap((curve) => [curve, { ...curve, run: 1, style: "dashes", label: "" }]);
  return { ...chart, curves, note: "" };
}
