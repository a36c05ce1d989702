/** A fault's promise and what the rig did about it, in words. Pure. */
import { quantity } from "../units.js";

/** The six that one tries first, with what the hand does. @type {[string, string, string][]} */
export const FIRST = [
  ["camera_unplugged", "Unplug the camera", "no more pictures come"],
  ["camera_frozen", "Freeze the camera", "one picture again and again"],
  ["line_jammed", "Jam the port", "the board gets no more bytes"],
  ["robot_hidden", "Hide the robot", "something covers it"],
  ["debris", "Scatter debris", "bits lie on the plate, some of the robot's colour"],
  ["loop_stalls", "Starve the CPU", "the loop stands still for 0.4 s"],
];

const STATES = { running: "walks on", armed: "stays armed", held: "holds", disarmed: "disarms", fault: "stops with a fault" };
const either = (words) => words.join(" or ");

const ms = (value) => quantity(value, "ms", 0);

/** "The rig holds within 104 ms, and no current flows after 255 ms." */
export function promiseWords({ states, noticed_ms, gone_ms }) {
  const what = `The rig ${either(states.map((state) => STATES[state] ?? state))}`;
  if (noticed_ms === null) return `${what}.`;
  return `${what} within ${ms(noticed_ms)}, and no current flows after ${ms(gone_ms)}.`;
}

/** The same of what was measured. */
export function reactionWords({ was, became, noticed_ms, gone_ms, verdict }) {
  if (verdict === "at_rest") return "No current flowed before, and none flows now.";
  if (became === null || became === was) return verdict === "watching" ? "Watching…" : `The rig ${STATES[was] ?? was}.`;
  const current = gone_ms === null ? "" : `, and no current flowed after ${ms(gone_ms)}`;
  return `The rig ${STATES[became] ?? became} after ${ms(noticed_ms)}${current}.`;
}

/** Verdict -> [sign, word, why]. @type {Record<string, [string, string, string]>} */
export const VERDICTS = {
  watching: ["…", "Watching", ""],
  kept: ["✓", "Kept", ""],
  broken: ["✗", "Not kept", "A busy computer may be late; try it again, and tell the makers if it stays so."],
  open: ["–", "Cannot say", "The promise is for a robot that walks, for the usual values, and for a rig that nothing else stops meanwhile."],
  at_rest: ["–", "At rest", "The promise is for a robot that walks: start a run, then try it again."],
};

/** [family, its faults] in the order of the catalogue, of those in which every word of the search occurs. */
export function grouped(faults, search) {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  const groups = new Map();
  for (const fault of faults) {
    const text = `${fault.title} ${fault.what} ${fault.family} ${fault.name}`.toLowerCase();
    if (words.every((word) => text.includes(word))) groups.set(fault.family, [...(groups.get(fault.family) ?? []), fault]);
  }
  return [...groups];
}

export const FAMILIES = {
  camera: "Camera and what it sees", line: "Line to the board", board: "Board, supply and coils", computer: "Computer",
  controller: "Controller", limits: "Limits", disk: "Disk",
};
