/** The log in words: what is shown of it, what nobody has seen, and how it is joined from its pages. */
import test from "node:test";
import assert from "node:assert/strict";
import { ageOf, asText, clockOf, joined, lasting, matching, unseen } from "../../web/log/words.js";

const line = (number, severity = "info", message = "armed", more = {}) => ({
  number, severity, message, code: "armed", at: "2026-11-23T14:05:09.000Z", time_s: number, run_id: null, ...more,
});
const LINES = [
  line(4, "error", "the camera has not given a frame for 120 ms", { code: "camera", run_id: "run-7" }),
  line(3, "warn", "coil y is at 91 % of its heat"),
  line(2, "info", "run started", { run_id: "run-7" }),
  line(1),
];
const numbers = (lines) => lines.map(({ number }) => number);

test("a severity shows itself and what is worse", () => {
  assert.deepEqual(numbers(matching(LINES, { severity: "all", text: "" })), [4, 3, 2, 1]);
  assert.deepEqual(numbers(matching(LINES, { severity: "warn", text: "" })), [4, 3]);
  assert.deepEqual(numbers(matching(LINES, { severity: "error", text: "" })), [4]);
});

test("every word that is looked for must be found, in message, code, run or severity, in any case", () => {
  assert.deepEqual(numbers(matching(LINES, { severity: "all", text: "  Frame CAMERA " })), [4]);
  assert.deepEqual(numbers(matching(LINES, { severity: "all", text: "run-7" })), [4, 2]);
  assert.deepEqual(numbers(matching(LINES, { severity: "all", text: "warning" })), [3]);
  assert.deepEqual(matching(LINES, { severity: "error", text: "heat" }), []);
});

test("unseen are warnings and faults that came after the one that was seen last", () => {
  assert.equal(unseen(LINES, 0), 2);
  assert.equal(unseen(LINES, 3), 1);
  assert.equal(unseen(LINES, 4), 0);
  assert.equal(unseen([], 0), 0);
});

test("pages that overlap are joined without doubles, newest first", () => {
  assert.deepEqual(numbers(joined(LINES.slice(0, 3), LINES.slice(1))), [4, 3, 2, 1]);
  assert.deepEqual(numbers(joined([], LINES)), [4, 3, 2, 1]);
  assert.deepEqual(numbers(joined(LINES, [])), [4, 3, 2, 1]);
});

test("the time is that of this computer's clock, with the day when it is not today", () => {
  const now = new Date(2026, 10, 23, 18, 0, 0);
  assert.equal(clockOf(new Date(2026, 10, 23, 14, 5, 9).toISOString(), now), "14:05:09");
  assert.equal(clockOf(new Date(2026, 10, 21, 4, 5, 9).toISOString(), now), "21 Nov 04:05:09");
  assert.equal(clockOf("nonsense", now), "–");
});

test("an age is told in its largest whole unit", () => {
  const now = new Date("2026-11-23T14:00:00Z");
  const before = (seconds) => new Date(now.getTime() - seconds * 1000).toISOString();
  assert.deepEqual([0, 4, 5, 59, 60, 3599, 3600, 86399, 86400].map((seconds) => ageOf(before(seconds), now)), [
    "just now", "just now", "5 s ago", "59 s ago", "1 min ago", "59 min ago", "1 h ago", "23 h ago", "1 d ago",
  ]);
  // A server whose clock is ahead of this one's.
  assert.equal(ageOf(before(-30), now), "just now");
  assert.equal(lasting(0), "0 s");
});

test("as a text the log reads from its beginning", () => {
  assert.equal(asText(LINES.slice(0, 2)), [
    "2026-11-23T14:05:09.000Z  warning  armed  coil y is at 91 % of its heat",
    "2026-11-23T14:05:09.000Z  fault  camera  [run-7]  the camera has not given a frame for 120 ms",
  ].join("\n"));
});
