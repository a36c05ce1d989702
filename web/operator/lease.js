/** Who operates, as the server tells it, and what this page asks for: at any time one page or script commands the rig. */
import { Problem, onRefusal, post, read, remove } from "../live/rest.js";
import { keep, recalled } from "../memory.js";
import { dismiss, get, say, set } from "../store.js";
import { isAsking, nameOf, newsOf, obstacleIn, whoOperates } from "./words.js";

/** @typedef {import("../types").Operator} Operator */

/** Where this browser remembers what its person is called. */
const NAME = "operator";

/** @returns {string} */
export const rememberedName = () => recalled(NAME) ?? "";

/** @param {import("../types").State} state */
export const obstacleOf = ({ operator }) => obstacleIn(operator);

let isByHand = false;
let changes = 0;

/** The server tells of a change. @param {Partial<Operator>} told */
export function hearOfOperator(told) {
  changes += 1;
  know(told);
}

/** @param {Partial<Operator>} told */
export function know(told) {
  const before = get().operator;
  const { you, you_may, holder, asking, lease_s, take_over_after_s } = { ...before, ...told };
  const after = { you, you_may, holder, asking, lease_s, take_over_after_s, heardAt: performance.now() };
  set({ operator: after });
  if (before.holder?.id !== holder?.id) for (const { id, action } of get().messages) if (action === ASK) dismiss(id);
  const news = newsOf(before, after, isByHand);
  if (news) say(news, "info", whoOperates(after) === "other" ? ASK : null);
  if (whoOperates(before) !== "you" && whoOperates(after) === "you") introduce(after);
}

/** The first command takes a free lease without a name. @param {Operator} operator */
function introduce({ holder }) {
  const name = rememberedName();
  if (name && holder?.name !== name) sendFor({ name });
}

export const loadOperator = () => carriedOut(async () => know(await unchanged(() => read("/operator"))));

/** An answer that a change has overtaken on its way is older than what the page knows: the newest is asked for. @param {() => Promise<any>} call */
async function unchanged(call) {
  let before = changes;
  let answer = (await call()) ?? {};
  while (before !== changes) {
    before = changes;
    answer = await read("/operator");
  }
  return answer;
}

/** @param {() => Promise<unknown>} call */
async function carriedOut(call) {
  try {
    await call();
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    if (problem.status !== 0) say(problem.message);
  }
}

/** @param {Record<string, string>} body */
const sendFor = (body) => carriedOut(async () => know(await unchanged(() => post("/operator", body))));

/** Takes control where it is free or due, asks for it otherwise. @param {{name?: string, note?: string}} words */
export function takeControl({ name = rememberedName(), note } = {}) {
  keep(NAME, name);
  return sendFor({ ...(name && { name }), ...(note && { note }) });
}

/** Gives the lease back, or takes the question back. */
export const release = () => handedOver(() => remove("/operator"));

/** @param {"grant" | "refuse"} answer */
export const answer = (answer) => handedOver(() => post("/operator", { answer }));

/** @param {() => Promise<any>} call */
async function handedOver(call) {
  isByHand = true;
  await carriedOut(async () => know(await unchanged(call)));
  isByHand = false;
}

const ASK = { words: "Ask for control", act: () => void takeControl() };

let isLeaving = false;

/** Where the server asks for a token, its own page takes it, and leads back here. */
function signIn() {
  if (isLeaving) return;
  isLeaving = true;
  addEventListener("pageshow", () => (isLeaving = false));
  location.assign(`/login?next=${encodeURIComponent(location.pathname + location.search + location.hash)}`);
}

onRefusal((problem) => {
  if (problem.status === 401) signIn();
  const { operator } = get();
  if (problem.status !== 409 || !problem.holder || problem.holder.id === operator.you) return;
  // The server's words are a script's; whoever says them on this page has these.
  problem.message = `${nameOf(problem.holder)} operates the rig: nothing was done.`;
  say(problem.message, "info", isAsking(operator) ? null : ASK);
});
