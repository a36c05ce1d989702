/** The event log in words: severities, when it was, what is looked for, and the whole as a text. Pure. */

/** @typedef {{number: number, at: string, time_s: number, severity: string, code: string, message: string, run_id: string | null}} LogEvent */

const SEVERITIES = { info: "info", warn: "warning", error: "fault" };
/** What can be shown: [name, words, severities]. */
export const CHOICES = [
  ["all", "All", ["info", "warn", "error"]],
  ["warn", "Warnings and faults", ["warn", "error"]],
  ["error", "Faults", ["error"]],
];

export const severityWord = (severity) => SEVERITIES[severity] ?? severity;

/**
 * @param {LogEvent[]} events
 * @param {{severity: string, text: string}} wanted every word of the text must be found
 */
export function matching(events, { severity, text }) {
  const [, , severities] = CHOICES.find(([name]) => name === severity) ?? CHOICES[0];
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  return events.filter((event) => severities.includes(event.severity) && words.every((word) => searched(event).includes(word)));
}

const searched = ({ message, code, run_id: run, severity }) =>
  `${message} ${code} ${run ?? ""} ${severityWord(severity)}`.toLowerCase();

/** Warnings and faults that came after the one that was seen last. @param {LogEvent[]} events newest first */
export function unseen(events, seen) {
  let count = 0;
  for (const { number, severity } of events) {
    if (number <= seen) break;
    if (severity !== "info") count += 1;
  }
  return count;
}

/** Newest first, without holes or doubles; what both have is told by `newer`. */
export function joined(newer, older) {
  const last = newer.at(-1)?.number ?? Infinity;
  return [...newer, ...older.filter(({ number }) => number < last)];
}

const two = (value) => String(value).padStart(2, "0");

/** "14:05:09", on this computer's clock; with the day when it is another one than today. */
export function clockOf(at, now = new Date()) {
  const time = new Date(at ?? "");
  if (Number.isNaN(time.getTime())) return "–";
  const clock = [time.getHours(), time.getMinutes(), time.getSeconds()].map(two).join(":");
  const day = time.toLocaleDateString("en-GB", { day: "numeric", month: "short" });
  return time.toDateString() === now.toDateString() ? clock : `${day} ${clock}`;
}

/** Below so many seconds, divided by so many, in this unit. @type {[number, number, string][]} */
const STEPS = [[60, 1, "s"], [3600, 60, "min"], [86400, 3600, "h"], [Infinity, 86400, "d"]];

/** "just now", "40 s ago", "12 min ago", "3 h ago", "2 d ago". */
export function ageOf(at, now = new Date()) {
  const seconds = (now.getTime() - new Date(at ?? "").getTime()) / 1000;
  if (Number.isNaN(seconds)) return "";
  return seconds < 5 ? "just now" : `${lasting(seconds)} ago`;
}

/** "40 s", "12 min", "3 h": how long something has been going on. */
export function lasting(seconds) {
  const [, unit, sign] = STEPS.find(([below]) => seconds < below) ?? STEPS[3];
  return `${Math.floor(Math.max(0, seconds) / unit)} ${sign}`;
}

/** A line an event, oldest first, as one reads a log. @param {LogEvent[]} events newest first */
export const asText = (events) =>
  events.map(({ at, severity, code, message, run_id: run }) => [at, severityWord(severity), code, run ? `[${run}]` : "", message].filter(Boolean).join("  "))
    .reverse().join("\n");
