/**
 * The study that is being made: its draft, and what the server says of it (how many runs, how long, what is wrong).
 * Asked whenever typing pauses; a late answer never replaces a newer one.
 */
import { download } from "../download.js";
import { post, Problem, read } from "../live/rest.js";
import { amend, get, say, set, useStore } from "../store.js";
import { definitionOf, draftOf, withField } from "./draft.js";
import { change as changeListing, loadStudies, openStudy } from "./listing.js";

const TYPING_PAUSE_MS = 300;

const NOTHING = {
  /** Grows when the whole draft is another one, so that its fields show it. */
  version: 0,
  /** {runs, sets, seconds, rig_seconds, toml} and problems by field, from the newest answer. */
  preview: null, problems: {}, error: "", asking: false, starting: false,
};

export const useDraft = (select) => useStore((state) => (state.composing ? select(state.composing) : null));
const now = () => get().composing;
/** @param {Partial<import("../types").Composing>} part */
const change = (part) => amend("composing", part);

/** A study of a selection, the page's own: what varies is still to be said. */
function fresh({ controller, trajectory, gait }) {
  return { name: "New study", on: "batch", design: "grid", repeats: 3, order: "blocked", seed: 1, controller, trajectory, gait, plant: { name: "slip" }, axes: [{ of: "gait.tilt_deg", values: [20, 25, 30] }] };
}

/** Opens the form, empty or with a definition to begin with. */
export async function compose(definition = null) {
  const { selection } = get();
  const wanted = definition ?? (selection && fresh(selection));
  if (wanted === null) return;
  changeListing({ open: null, study: null });
  begin(wanted);
  if (get().plants.length === 0) await loadPlants();
}

async function loadPlants() {
  try {
    set({ plants: await read("/plants") });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    say(`The plants cannot be listed: ${problem.message}`);
  }
}

function begin(definition) {
  set({ composing: { ...NOTHING, version: (now()?.version ?? 0) + 1, ...draftOf(definition) } });
  ask();
}

export function closeForm() {
  clearTimeout(typing);
  asked += 1;
  set({ composing: null });
}

let typing = 0;
let asked = 0;

function edit(part) {
  change(part);
  clearTimeout(typing);
  typing = setTimeout(ask, TYPING_PAUSE_MS);
}

export const setField = (path, value) => edit({ rest: withField(now()?.rest, path, value) });
export const setFields = (part) => edit({ rest: { ...now()?.rest, ...part } });
export const setAxes = (axes) => edit({ axes });

/** What the page has selected now, in place of what the form began with. */
export const takeSelection = () => setFields(get().selection);

async function ask() {
  const draft = now();
  if (!draft) return;
  const own = (asked += 1);
  change({ asking: true });
  try {
    const answer = await post("/studies/preview", { definition: definitionOf(draft) });
    if (own === asked) change({ preview: answer, problems: byField(answer.problems), error: "", asking: false });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (own === asked) change({ error: problem.message, asking: false });
  }
}

/** The first that is wrong with each field; "" for what has no place. */
function byField(problems) {
  const fields = {};
  for (const { field, message } of problems) fields[field] ??= message;
  return fields;
}

/** Makes the study and begins it. consent: to current through the coils of a real rig. */
export async function start(consent = false) {
  const draft = now();
  if (!draft || draft.starting) return;
  change({ starting: true, error: "" });
  try {
    const study = await post("/studies", { definition: definitionOf(draft), consent });
    closeForm();
    await Promise.all([openStudy(study.id), loadStudies()]);
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ starting: false, error: problem.message });
  }
}

/** A definition from a file in place of the form's. */
export async function takeFile(file) {
  try {
    const answer = await post("/studies/preview", { toml: await file.text() });
    if (answer.definition) begin(answer.definition);
    else change({ error: `${file.name}: ${answer.problems.map(({ message }) => message).join(" ")}` });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ error: `${file.name}: ${problem.message}` });
  }
}

/** The form's definition as a file to keep. */
export function saveFile() {
  const draft = now();
  if (!draft?.preview) return;
  const { preview, rest } = draft;
  download(`${fileName(rest.name)}.toml`, preview.toml, "application/toml");
}

const fileName = (name) => (name ?? "").trim().toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "study";
