import assert from "node:assert/strict";
import test from "node:test";
import { target } from "../../web/login/login.js";

const RIG = "http://rig.lab:8000";

test("who has logged in comes to where they wanted to go on this rig", () => {
  assert.equal(target("?next=/docs", RIG), `${RIG}/docs`);
  assert.equal(target("?next=/%23runs", RIG), `${RIG}/#runs`);
  assert.equal(target("", RIG), `${RIG}/`);
});

test("a login leads to no other site, to no script and not to itself", () => {
  const places = ["https://evil.example/", "//evil.example/", "\\\\evil.example", "javascript:alert(1)", "/login", "http://[", "data:,x"];
  for (const place of places) {
    assert.equal(target(`?next=${encodeURIComponent(place)}`, RIG), `${RIG}/`, place);
  }
});
