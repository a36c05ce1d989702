/** What the tab of the rig knows and does: the draft of other values, saving, undoing, files, and who is connected. */
import { patch, post, Problem, read } from "../live/rest.js";
import { get, set, useStore } from "../store.js";
import { at, errorTexts, isSame, nested } from "./fields.js";

/** @type {import("../types").RigPage} */
const CLOSED = {
  section: "about", search: "",
  /** GET /rig/schema, GET /about, GET /ports and GET /cameras; null until they come. */
  schema: null, about: null, ports: null, cameras: null,
  /** Other values, by their path. */
  draft: {},
  /** What goes on in words; what went wrong; what was done: {words, undo: whether it can be undone}. */
  working: "", error: "", done: null,
  /** A rig file that was chosen: {name, text, differences, error}, or null. */
  file: null,
  /** What came of the test of the webhook. */
  tested: null,
};

/**
 * @template T
 * @param {(page: import("../types").RigPage) => T} select
 */
export const useRigPage = (select) => useStore((state) => select(state.rigPage ?? CLOSED));

const now = () => get().rigPage ?? CLOSED;
export const change = (part) => set({ rigPage: { ...now(), ...part } });

const SOURCES = { schema: "/rig/schema", about: "/about", ports: "/ports", cameras: "/cameras" };

/** Reads one of the answers again; what cannot be read is said once for all. */
export async function learn(name) {
  try {
    change({ [name]: await read(SOURCES[name]) });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ error: problem.message });
  }
}

export function openRigPage() {
  change({ error: "" });
  if (now().schema === null) learn("schema");
  learn("about");
}

export const showSection = (section) => change({ section, search: "", done: null });
export const search = (text) => change({ search: text });

/** Takes a value into the draft; one that is as the rig has it is no change. */
export function put(path, value) {
  const { [path]: _, ...others } = now().draft;
  const draft = isSame(value, at(get().rig, path)) ? others : { ...others, [path]: value };
  change({ draft, done: null });
  forget(path);
}

/** The server's word on a value that is another one now. */
function forget(path) {
  const kept = Object.entries(get().serverErrors).filter(([key]) => key !== `rig.${path}` && !key.startsWith(`rig.${path}.`));
  set({ serverErrors: Object.fromEntries(kept) });
}

export function discard(path) {
  if (path) return put(path, at(get().rig, path));
  change({ draft: {}, error: "" });
  return set({ serverErrors: {} });
}

/** Does one thing at a time and says so. @returns the answer, or null when it was refused */
export async function doing(words, call) {
  if (now().working) return null;
  change({ working: words, error: "", done: null });
  try {
    return (await call()) ?? true;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    set({ serverErrors: errorTexts(problem.errors) });
    change({ error: problem.message });
    return null;
  } finally {
    change({ working: "" });
  }
}

/**
 * The rig with its file after a change, without what was only said of the change.
 * @param {any} answer @returns {string[]} names of the values that are others now
 */
function adopt(answer) {
  const { changed, rebuilt: _, ...rig } = answer;
  set({ rig });
  return changed;
}

const counted = (count) => (count === 1 ? "one value" : `${count} values`);

export async function save() {
  const answer = await doing("Saving", () => patch("/rig", nested(now().draft)));
  if (answer === null) return;
  const changed = adopt(answer);
  change({ draft: {}, done: { words: `Saved: ${counted(changed.length)} changed.`, undo: true } });
}

export async function undo() {
  const answer = await doing("Undoing", () => post("/rig/undo"));
  if (answer !== null) change({ done: { words: `Undone: ${counted(adopt(answer).length)} put back.`, undo: false } });
}

/** Looks at a rig file that somebody has chosen; nothing changes. @param {File} chosen */
export async function choose(chosen) {
  const text = await chosen.text();
  const file = { name: chosen.name, text, differences: null, error: "" };
  change({ file, error: "", done: null });
  try {
    const { differences } = await post("/rig/import", { toml: text });
    change({ file: { ...file, differences } });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    change({ file: { ...file, error: problem.message } });
  }
}

export const putAway = () => change({ file: null });

export async function apply() {
  const { file } = now();
  if (!file) return;
  const answer = await doing("Applying the file", () => post("/rig/import", { toml: file.text, apply: true }));
  if (answer === null) return;
  change({ file: null, draft: {}, done: { words: `Applied ${file.name}: ${counted(adopt(answer).length)} changed.`, undo: true } });
}

export async function tryWebhook() {
  change({ tested: null });
  const answer = await doing("Sending a test", () => post("/notifications/test"));
  if (answer !== null) change({ tested: answer });
}
