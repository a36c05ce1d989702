/** Runs in words: what they are called, when they were, how large they are, and what is there to replay. Pure. */
import { clock, fixed } from "../units.js";

const GIGA = 1e9;
const MEGA = 1e6;
const KILO = 1e3;

export const nameOf = (run) => run.label || run.id;
export const partName = (part) => (typeof part === "string" ? part : (part?.name ?? "–"));

/** "18.3 GB", "640 kB": three digits or fewer before the unit. */
export function bytes(count) {
  if (typeof count !== "number" || !Number.isFinite(count)) return "–";
  if (count >= GIGA) return `${fixed(count / GIGA, 1)} GB`;
  if (count >= MEGA) return `${fixed(count / MEGA, count >= 100 * MEGA ? 0 : 1)} MB`;
  return `${fixed(count / KILO, 0)} kB`;
}

/** "1 run", "12 runs". */
export const counted = (count, noun) => `${count.toLocaleString("en")} ${noun}${count === 1 ? "" : "s"}`;

/** @type {Intl.DateTimeFormatOptions} */
const DAY = { day: "numeric", month: "short" };
/** @type {Intl.DateTimeFormatOptions} */
const TIME = { hour: "2-digit", minute: "2-digit", hour12: false };

/** "23 Nov 14:05", with the year when it is another one; in this computer's time zone. */
export function when(text, now = new Date()) {
  const time = new Date(text ?? "");
  if (Number.isNaN(time.getTime())) return "–";
  /** @type {Intl.DateTimeFormatOptions} */
  const day = time.getFullYear() === now.getFullYear() ? DAY : { ...DAY, year: "numeric" };
  return `${time.toLocaleDateString("en-GB", day)} ${time.toLocaleTimeString("en-GB", TIME)}`;
}

/** To the second and with the day of the week. */
export function exactly(text) {
  const time = new Date(text ?? "");
  return Number.isNaN(time.getTime()) ? "–" : time.toLocaleString("en-GB", { dateStyle: "full", timeStyle: "medium" });
}

/** "42.3 s", "12:05 min". */
export function lasted(seconds) {
  if (typeof seconds !== "number" || !Number.isFinite(seconds)) return "–";
  return seconds < 100 ? `${fixed(seconds, 1)} s` : `${clock(seconds)} min`;
}

const isSaved = ({ recording }) => ["complete", "recovered"].includes(recording?.state);

/** Why a run cannot be replayed or taken away, in words; "" when it can. */
export function whyNothingToReplay(run) {
  if (run.state === "running") return "The run goes on; replay and downloads come when it has ended.";
  if (isSaved(run)) return "";
  return UNSAVED[run.recording?.state] ?? UNSAVED.none;
}

const UNSAVED = {
  none: "Nothing to replay: this run was not recorded.",
  writing: "The recording is being finished; a moment.",
  lost: "Nothing to replay: the recording is gone or cannot be read.",
};

/** What is to be known of how a run ended and of its recording, in sentences. */
export function remarks(run) {
  const interrupted = run.state === "interrupted" && (run.reason || "The program ended during this run; what was recorded up to then is here.");
  const recovered = run.recording?.state === "recovered" && "The recording was torn; its readable part has been recovered.";
  const ended = run.state !== "interrupted" && run.state !== "finished" && run.reason;
  return [interrupted, ended, recovered, whyNothingToReplay(run)].filter(Boolean);
}
