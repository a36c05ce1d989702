/** What a message of the telemetry stream is worth to somebody who is not looking, in words. Pure. */

/** What a person has done by hand needs no telling. */
const BY_HAND = ["estop", "ended"];
const ENDED_STUDY = ["stopped", "finished", "failed", "interrupted"];
const ENDED_RUN = ["finished", "stopped", "aborted"];

/**
 * @param {any} message
 * @returns {{title: string, text: string, tag: string, tab: string} | null} tag: a newer one with it takes its place
 */
export function worthTelling(message) {
  const { type, event } = message;
  if (type === "event") return ofFault(message);
  if (type === "study" && event === "ended") return ofStudy(message.study);
  if (type === "run" && message.run?.unattended && ENDED_RUN.includes(event)) return ofRun(message.run);
  return null;
}

function ofFault({ severity, code, message }) {
  if (severity !== "error" || BY_HAND.includes(code)) return null;
  return { title: "Fault", text: sentence(message), tag: `fault ${code}`, tab: "log" };
}

function ofStudy({ id, name, state, reason, done, total, failed }) {
  if (!ENDED_STUDY.includes(state)) return null;
  const words = [`${done} of ${total} runs`, failed > 0 && `${failed} failed`, reason].filter(Boolean).join(", ");
  return { title: `Study ${state}`, text: `${name}: ${words}`, tag: `study ${id}`, tab: "studies" };
}

function ofRun({ id, label, state, reason }) {
  return { title: `Run ${state}`, text: [label || id, reason].filter(Boolean).join(": "), tag: `run ${id}`, tab: "runs" };
}

const sentence = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);
