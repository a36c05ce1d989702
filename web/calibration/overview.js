/** The tab of calibrations: what is measured on this rig, how well, how long ago, and the way to measure it. */
import { Problem, read } from "../live/rest.js";
import { closeReplay } from "../replay/replay.js";
import { get, set, useStore } from "../store.js";
import { html, useEffect } from "../view.js";
import { dateWords } from "./grades.js";
import { dayAge, rowsOf } from "./rows.js";
import { goTo, openSetup } from "./setup.js";

const SOURCES = { calibration: "/calibration", star: "/calibration/star", latency: "/calibration/latency", vision: "/vision" };
const NOTHING = { calibration: null, star: null, latency: null, vision: null, error: "" };

let turn = 0;

/** What is saved now; a late answer to an earlier question does not count any more. */
async function learn() {
  const own = (turn += 1);
  try {
    const answers = await Promise.all(Object.values(SOURCES).map(read));
    if (own !== turn) return;
    set({ calibrations: { ...NOTHING, ...Object.fromEntries(Object.keys(SOURCES).map((name, index) => [name, answers[index]])) } });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (own === turn) set({ calibrations: { ...(get().calibrations ?? NOTHING), error: problem.message } });
  }
}

export function Overview() {
  const rig = useStore((state) => state.rig);
  const known = useStore((state) => state.calibrations);
  const tracking = useStore((state) => state.tick?.tracking ?? "");
  const settingUp = useStore((state) => state.setup !== null);
  useEffect(() => void learn(), [rig, settingUp]);
  if (!known) return html`<p class="hint padded">Asking what is calibrated…</p>`;
  const rows = rowsOf({ ...known, rig, tracking });
  return html`
    <section aria-label="Calibration">
      ${known.error && html`<p class="padded field-error" role="alert">${known.error} <button type="button" onClick=${learn}>Try again</button></p>`}
      <ul class="calibrations">${rows.map((row) => html`<${Line} key=${row.name} row=${row} />`)}</ul>
    </section>
  `;
}

const MARKS = { done: "✓", wrong: "!", open: "–" };
const MEANINGS = { done: "calibrated", wrong: "needs attention", open: "assumed" };

function Line({ row }) {
  const { title, about, standing, found, grade, date, why, step, command } = row;
  return html`
    <li data-standing=${standing} aria-label=${title}>
      <span class="number" aria-hidden="true">${MARKS[standing]}</span>
      <span class="what"><strong>${title}</strong><span class="soft">${about}</span></span>
      <span class="found">
        <span><span class="unseen">${MEANINGS[standing]}: </span>${found && html`<strong>${found}</strong>`}${grade && html` <span class="grade" data-grade=${grade}>${grade}</span>`}</span>
        <span class="soft why">${[date && `${dateWords(date)}, ${dayAge(date)}`, why].filter(Boolean).join(" · ")}</span>
      </span>
      ${step ? html`<${Begin} step=${step} title=${title} />` : html`<span class="act"><code title="On the rig’s computer, with this server stopped">${command}</code></span>`}
    </li>
  `;
}

function Begin({ step, title }) {
  const settingUp = useStore((state) => state.setup?.step === step);
  const begin = () => {
    if (get().replay) closeReplay();
    if (!get().setup) openSetup();
    goTo(step);
    scrollTo({ top: 0 });
  };
  return html`<span class="act"><button type="button" disabled=${settingUp} aria-label=${`Calibrate: ${title}`} onClick=${begin}>Calibrate</button></span>`;
}
