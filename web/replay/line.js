/** Asks the server what the recordings hold at the time that is shown: one question at a time, the newest only. */
import { keepOpen } from "../live/socket.js";
import { amend, say } from "../store.js";
import { now_s, onTime, waitWhile } from "./player.js";

/** Questions are at least so far apart: a screen cannot show more, ms. */
const PERIOD_MS = 33;
/** The clock waits for an answer that takes longer, ms. */
const PATIENCE_MS = 400;
/** Before each picture: which run it is of, and a reserved number, both unsigned 32 bits, little endian. */
const HEADER_BYTES = 8;
/** How the server closes the line to a recording that is not there, or that nobody can read. */
const NOT_THERE = 4404;

/** The newest answer: {at_s, ticks: [tick or null per run], pictures: [{time_s, captured_s, tick} or null per run]}. */
export const answer = { at_s: 0, ticks: [], pictures: null };

const answerListeners = new Set();
/** Index of a run -> hears of its pictures. */
const pictureListeners = new Map();
/** Indices of runs whose pictures are scrolled away. */
const outOfSight = new Set();
/** Index of a run -> its newest picture, which the server does not send twice, and whether it is the one shown. */
const pictures = new Map();

/** @type {{close: () => void} | null} */
let socket = null;
/** @type {(() => void) | null} */
let forgetTime = null;
/** @type {((text: string) => void) | null} */
let send = null;
let waiting = false;
/** @type {{at_s: number | null, frame: boolean | null, at: number}} */
let asked = { at_s: null, frame: null, at: -Infinity };
let timer = 0;

export function onAnswer(listener) {
  answerListeners.add(listener);
  return () => answerListeners.delete(listener);
}

/** Pictures of one run, as {image: Blob or null when there is none at this time, about: what is known of it}. */
export function onPicture(index, listener) {
  pictureListeners.set(index, listener);
  if (pictures.get(index)?.shown) listener(pictures.get(index));
  askAgain();
  return () => pictureListeners.get(index) === listener && pictureListeners.delete(index);
}

/** Pictures that are out of sight need not come. */
export function look(index, inSight) {
  if (inSight) outOfSight.delete(index);
  else outOfSight.add(index);
  askAgain();
}

const NO_PICTURE = { image: null, about: null };

/** What the newest answer says of a run's picture; a new one follows by itself. */
function tellOfPicture(about, index) {
  const known = pictures.get(index);
  if (about === null && known) known.shown = false;
  if (about === null) pictureListeners.get(index)?.(NO_PICTURE);
  else if (!about.new && known && !known.shown) showPicture(index, known);
}

function showPicture(index, picture) {
  pictures.set(index, { ...picture, shown: true });
  pictureListeners.get(index)?.(picture);
}

/** notThere: hears why when the recordings are gone, and there is nothing to wait for. */
export function openLine(ids, notThere) {
  const query = ids.map((id) => `run=${encodeURIComponent(id)}`).join("&");
  const lose = (cause, _, code) => (code === NOT_THERE ? notThere(cause) : lost(cause));
  socket = keepOpen(`/api/v1/replay?${query}`, { message: receive, lost: lose });
  forgetTime = onTime(ask);
  waitWhile(() => send === null || (waiting && performance.now() - asked.at > PATIENCE_MS));
}

export function closeLine() {
  socket?.close();
  forgetTime?.();
  socket = forgetTime = send = null;
  pictures.clear();
  Object.assign(answer, { at_s: 0, ticks: [], pictures: null });
}

/** @param {Partial<import("../types").Replay>} part */
const change = (part) => amend("replay", part);

function lost(cause) {
  send = null;
  change({ status: "lost", cause });
}

function receive(data, reply) {
  if (data instanceof Blob) return receivePicture(data);
  const message = JSON.parse(data);
  return handlers[message.type]?.(message, reply);
}

const handlers = {
  ready({ session }, reply) {
    send = reply;
    waiting = false;
    change({ status: "open", cause: "", session });
    askAgain();
  },

  replay({ at_s, ticks, pictures: abouts }) {
    waiting = false;
    Object.assign(answer, { at_s, ticks, pictures: abouts });
    if (asked.frame) abouts?.forEach(tellOfPicture);
    for (const listener of answerListeners) listener(answer);
    ask();
  },

  problem({ detail }) {
    waiting = false;
    say(`The recording cannot be read here: ${detail}`);
  },
};

async function receivePicture(blob) {
  const abouts = answer.pictures;
  const line = socket;
  const header = new DataView(await blob.slice(0, HEADER_BYTES).arrayBuffer());
  // Of a replay that was closed meanwhile.
  if (line !== socket) return;
  const index = header.getUint32(0, true);
  const image = blob.slice(HEADER_BYTES, blob.size, "image/jpeg");
  showPicture(index, { image, about: abouts?.[index] ?? null });
}

/** The same time once more: somebody wants to see what was not asked for before. */
function askAgain() {
  asked = { ...asked, at_s: null };
  ask();
}

function ask() {
  if (send === null || waiting) return;
  const at_s = now_s();
  const frame = [...pictureListeners.keys()].some((index) => !outOfSight.has(index));
  if (at_s === asked.at_s && frame === asked.frame) return;
  const rest = PERIOD_MS - (performance.now() - asked.at);
  if (rest > 0) {
    timer ||= setTimeout(() => {
      timer = 0;
      ask();
    }, rest);
    return;
  }
  asked = { at_s, frame, at: performance.now() };
  waiting = true;
  send(JSON.stringify({ at_s, frame }));
}
