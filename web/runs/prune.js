/** Makes room: runs that are old, or the oldest until the rest is small enough; first it shows what would go. */
import { Ask } from "../ask.js";
import { post, Problem } from "../live/rest.js";
import { html, useEffect, useRef, useState } from "../view.js";
import { Names } from "./delete.js";
import { dropRuns } from "./listing.js";
import { bytes, counted } from "./words.js";

const TYPING_PAUSE_MS = 350;

/** What is asked for: null for an empty field, undefined for a text that is no number. */
function numberOf(text) {
  const trimmed = text.trim().replace(",", ".");
  if (trimmed === "") return null;
  const value = Number(trimmed);
  return Number.isFinite(value) && value > 0 ? value : undefined;
}

function bodyOf({ days, size }) {
  const [older, until] = [numberOf(days), numberOf(size)];
  if (older === undefined || until === undefined) throw new Problem("Write a number above 0, such as 30.");
  if (older === null && until === null) return null;
  return { ...(older === null ? {} : { older_than_days: older }), ...(until === null ? {} : { until_size_GB: until }) };
}

export function PruneDialog({ close }) {
  const [wish, setWish] = useState({ days: "", size: "" });
  const { found, error, working, go } = usePrune(wish, close);
  const type = (name) => (event) => setWish({ ...wish, [name]: event.target.value });
  return html`
    <${Ask} title="Prune runs" close=${close}>
      <p class="hint">Pinned runs and one that goes on always stay.</p>
      <div class="fields">
        <${Entry} title="Older than" unit="days" value=${wish.days} onInput=${type("days")} first />
        <${Entry} title="Oldest first, until all take" unit="GB" value=${wish.size} onInput=${type("size")} />
      </div>
      <div class="would-go" aria-live="polite">
        ${error && html`<p class="field-error">${error}</p>`}
        ${!error && html`<p>${wordsOf(found)}</p>`}
        ${found?.runs.length > 0 && html`<${Names} runs=${found.runs} />`}
      </div>
      <div class="choice">
        <button class="danger" type="button" disabled=${working || !found?.runs.length} onClick=${go}>
          ${found?.runs.length ? `Delete ${counted(found.runs.length, "run")}` : "Delete"}</button>
        <button type="button" onClick=${close}>Keep all</button>
      </div>
    <//>
  `;
}

function wordsOf(found) {
  if (found === null) return "Say what may go.";
  if (found.runs.length === 0) return "Nothing would go.";
  return `${counted(found.runs.length, "run")}, ${bytes(found.bytes)} would go. This cannot be undone.`;
}

function Entry({ title, unit, value, onInput, first = false }) {
  return html`
    <label class="field"><span class="soft">${title}</span>
      <span class="entry"><input type="text" inputmode="decimal" autocomplete="off" value=${value} onInput=${onInput} data-first=${first || undefined} /><span class="unit">${unit}</span></span>
    </label>
  `;
}

/** Asks what would go whenever the wish changes; `go` deletes exactly by the wish that was shown. */
function usePrune(wish, close) {
  /** @type {[{found: any, error: string, working: boolean}, (state: any) => void]} */
  const [state, setState] = useState({ found: null, error: "", working: false });
  const newest = useRef(0);
  const ask = async (dry) => {
    const own = (newest.current += 1);
    try {
      const body = bodyOf(wish);
      const answer = body && (await post("/runs/prune", { ...body, dry_run: dry }));
      if (own === newest.current) setState({ found: answer, error: "", working: false });
      return answer;
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      if (own === newest.current) setState({ found: null, error: problem.message, working: false });
      return null;
    }
  };
  useEffect(() => {
    const timer = setTimeout(() => ask(true), TYPING_PAUSE_MS);
    return () => clearTimeout(timer);
  }, [wish.days, wish.size]);
  const go = async () => {
    setState({ ...state, working: true });
    const answer = await ask(false);
    if (answer === null) return;
    dropRuns(answer.runs.map(({ id }) => id));
    close();
  };
  return { ...state, go };
}
