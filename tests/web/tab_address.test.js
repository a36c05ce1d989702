/** The open tab in the page's address. */
import test from "node:test";
import assert from "node:assert/strict";
import { addressWith, tabIn } from "../../web/journal/tab_address.js";

const NAMES = ["runs", "log"];

test("only a tab that there is can be named", () => {
  assert.equal(tabIn("http://rig/?tab=log", NAMES), "log");
  assert.equal(tabIn("http://rig/?tab=elsewhere", NAMES), null);
  assert.equal(tabIn("http://rig/", NAMES), null);
});

test("another tab leaves the recording that is shown, and the first tab needs no word", () => {
  assert.equal(addressWith("http://rig/#replay=a,b", "log"), "http://rig/?tab=log#replay=a,b");
  assert.equal(addressWith("http://rig/?tab=log#replay=a", "runs"), "http://rig/#replay=a");
});
