/** By which name the server knows a tab, and how it hears that somebody looks at it. */
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

const define = (name, value) => Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });

/** A tab: what it keeps over a reload, and what happens to it. */
class Tab extends EventTarget {
  kept = new Map();
  hidden = false;

  happens = (name) => this.dispatchEvent(new Event(name));

  hides(hidden) {
    this.hidden = hidden;
    this.happens("visibilitychange");
  }
}

let tab = new Tab();
let loads = 0;

function open(another) {
  tab = another;
  define("document", tab);
  define("addEventListener", tab.addEventListener.bind(tab));
  define("sessionStorage", {
    getItem: (name) => tab.kept.get(name) ?? null,
    setItem: (name, value) => tab.kept.set(name, value),
    removeItem: (name) => tab.kept.delete(name),
  });
}

/** The page of a tab; each load is a module of its own. */
async function load() {
  loads += 1;
  const client = await import(`../../web/live/client.js?${loads}`);
  client.keepOverReload();
  return client.CLIENT;
}

beforeEach(() => open(new Tab()));

test("a page that is loaded anew has the name of the one before", async () => {
  const first = await load();
  assert.match(first, /^[0-9a-f]{32}$/);
  tab.happens("pagehide");
  assert.equal(await load(), first);
});

test("a tab that is duplicated is another client", async () => {
  const first = await load();
  const twin = new Tab();
  twin.kept = new Map(tab.kept);
  open(twin);
  assert.notEqual(await load(), first);
});

test("so is one that is duplicated after its page was left and shown again", async () => {
  const first = await load();
  tab.happens("pagehide");
  tab.happens("pageshow");
  assert.equal(tab.kept.size, 0);
  tab.happens("pagehide");
  assert.equal(await load(), first);
});

test("a browser that keeps nothing has a name all the same", async () => {
  define("sessionStorage", undefined);
  assert.match(await load(), /^[0-9a-f]{32}$/);
  tab.happens("pagehide");
});

test("a page that is seen says so each second, and one that is hidden says it once", async (t) => {
  t.mock.timers.enable({ apis: ["setInterval"] });
  const { keepBeating } = await import("../../web/live/heartbeat.js");
  const sent = [];
  keepBeating((text) => sent.push(JSON.parse(text)));
  t.mock.timers.tick(3000);
  tab.hides(true);
  t.mock.timers.tick(5000);
  tab.hides(false);
  t.mock.timers.tick(1000);
  assert.deepEqual(sent.map(({ visible }) => visible), [true, true, true, false, true, true]);
  assert.ok(sent.every(({ type }) => type === "heartbeat"));
});

test("a page that is left says nothing: it may come back at once", async (t) => {
  t.mock.timers.enable({ apis: ["setInterval"] });
  const { keepBeating } = await import("../../web/live/heartbeat.js");
  const sent = [];
  keepBeating((text) => sent.push(text));
  tab.happens("pagehide");
  tab.hides(true);
  assert.deepEqual(sent, []);
});
