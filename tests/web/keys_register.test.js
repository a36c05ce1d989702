/** Keys of the page: who offers them, which one counts, and what the sheet shows. */
import test from "node:test";
import assert from "node:assert/strict";
import { bindingOf, fits, register, sheet, signsOf } from "../../web/keys/register.js";

const press = (key, more = {}) => ({ key, ctrlKey: false, altKey: false, metaKey: false, shiftKey: false, ...more });
const act = () => {};

test("a key with a modifier belongs to the browser", () => {
  const binding = { key: "p", words: "" };
  assert.ok(fits(press("p"), binding));
  for (const modifier of ["ctrlKey", "altKey", "metaKey", "shiftKey"]) {
    assert.ok(!fits(press(modifier === "shiftKey" ? "P" : "p", { [modifier]: true }), binding), modifier);
  }
});

test("a sign that needs Shift on its keyboard is the same sign", () => {
  assert.ok(fits(press("?", { shiftKey: true }), { key: "?", words: "" }));
});

test("Caps Lock changes nothing", () => {
  assert.ok(fits(press("P"), { key: "p", words: "" }));
});

test("what was offered last is in front, until it is taken away", () => {
  const first = { key: "k", words: "first", act };
  const second = { key: "k", words: "second", act };
  const removeFirst = register("One", () => [first]);
  const removeSecond = register("Two", () => [second]);
  assert.equal(bindingOf(press("k")), second);
  removeSecond();
  assert.equal(bindingOf(press("k")), first);
  removeFirst();
  assert.equal(bindingOf(press("k")), null);
});

test("the sheet shows what works now and nothing else, and words alone are heeded by nobody", () => {
  let works = false;
  const remove = register("Jog", () => [{ key: "q", words: "left", act, when: () => works }, { key: "x", words: "told" }]);
  assert.deepEqual(sheet().map(([group, list]) => [group, list.map(({ words }) => words)]), [["Jog", ["told"]]]);
  assert.equal(bindingOf(press("q")), null);
  works = true;
  assert.equal(sheet()[0][1].length, 2);
  assert.equal(bindingOf(press("x")), null);
  remove();
  assert.deepEqual(sheet(), []);
});

test("two offers of one group are one list", () => {
  const removes = ["a", "b"].map((key) => register("Run", () => [{ key, words: key, act }]));
  assert.deepEqual(sheet().map(([group, list]) => [group, list.length]), [["Run", 2]]);
  for (const remove of removes) remove();
});

test("keys are written as on a keyboard", () => {
  assert.deepEqual(signsOf({ key: ["arrowleft", "q"], words: "" }), ["←", "Q"]);
});
