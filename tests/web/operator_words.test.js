/** Who operates, in words. */
import assert from "node:assert/strict";
import test from "node:test";

import { isAsking, newsOf, obstacleIn, questionWords, silence, standing, standingWords, untilTakeOver } from "../../web/operator/words.js";

const ANNA = { id: "a1", name: "Anna", note: "calibrating", kind: "page", since_s: 60, silent_s: 0.4 };
const BEN = { id: "b2", name: "Ben", note: "", kind: "page", since_s: 3, silent_s: 0 };
const FREE = { you: "me", you_may: "operate", holder: null, asking: null, lease_s: 2, take_over_after_s: 10, heardAt: 1000 };
const hers = { ...FREE, holder: ANNA };
const mine = { ...FREE, holder: { ...BEN, id: "me" } };

test("the bar names who operates and why, shortly where there is little room", () => {
  assert.deepEqual(standing(FREE, 1000), ["Nobody operates", "", "Nobody"]);
  assert.deepEqual(standing(mine, 1000), ["You operate", "", "You"]);
  assert.deepEqual(standing(hers, 1000), ["Anna operates", "calibrating", "Anna"]);
  assert.equal(standing({ ...FREE, holder: { ...BEN, name: "" } }, 1000)[0], "Somebody operates");
  assert.equal(standing({ ...FREE, holder: { ...BEN, name: "", kind: "script" } }, 1000)[0], "A script operates");
});

test("the same in one line", () => {
  assert.deepEqual([FREE, mine, hers].map((operator) => standingWords(operator, 1000)), ["Nobody operates", "You operate", "Anna operates – calibrating"]);
});

test("a holder who is silent for longer than the lease is told to be, and for how long goes on by itself", () => {
  const silent = { ...hers, holder: { ...ANNA, silent_s: 3 } };
  assert.equal(silence(hers, 9000), 0);
  assert.equal(silence(silent, 3000), 5);
  assert.equal(standingWords(silent, 3000), "Anna operates, silent for 5 s");
});

test("a command is in nobody's way while the lease is free or this page's own", () => {
  assert.equal(obstacleIn(FREE), "");
  assert.equal(obstacleIn(mine), "");
  assert.match(obstacleIn(hers), /^Anna operates\. .*STOP, pause and disarm work/);
});

test("who came in to watch may only watch, whoever operates", () => {
  for (const operator of [FREE, hers]) assert.match(obstacleIn({ ...operator, you_may: "view" }), /may watch this rig, not operate it/);
});

test("somebody asks with or without a name and a reason", () => {
  assert.equal(questionWords({ name: "Anna", note: "calibrating" }), "Anna asks for control: “calibrating”");
  assert.equal(questionWords({ name: "", note: "" }), "Somebody asks for control");
});

test("ten seconds after the question, or at once when the holder is silent, one may take over", () => {
  const asked = { ...hers, asking: { id: "me", name: "", note: "", since_s: 2 } };
  assert.equal(untilTakeOver(asked, 1000), 8);
  assert.equal(untilTakeOver(asked, 4000), 5);
  assert.equal(untilTakeOver(asked, 20_000), 0);
  assert.equal(untilTakeOver({ ...asked, holder: { ...ANNA, silent_s: 2.5 } }, 1000), 0);
  assert.ok(isAsking(asked));
  assert.ok(!isAsking(hers) && !isAsking({ ...FREE, you: undefined }));
});

test("who loses the lease hears who took it and why, unless it was given away", () => {
  assert.equal(newsOf(mine, hers, false), "Anna has taken control: “calibrating”.");
  assert.match(newsOf(mine, FREE, false), /no longer operate/);
  assert.equal(newsOf(mine, hers, true), "");
  assert.equal(newsOf(mine, { ...mine, asking: { id: "b2", name: "Ben", note: "", since_s: 0 } }, false), "");
  assert.equal(newsOf(FREE, hers, false), "");
});

test("who asked hears that the answer is no, or that somebody else was faster", () => {
  const asked = { ...hers, asking: { id: "me", name: "", note: "", since_s: 2 } };
  assert.equal(newsOf(asked, hers, false), "Anna keeps control.");
  assert.equal(newsOf(asked, { ...FREE, holder: BEN }, false), "Ben operates now.");
  assert.equal(newsOf(asked, mine, false), "");
  assert.equal(newsOf(asked, hers, true), "");
});
