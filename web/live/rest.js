/** The REST calls: JSON in, JSON out, problem+json turned into one kind of error. */
import { CLIENT } from "./client.js";

/** A refusal by the server (or its silence), in words; `fields` maps "controller.gain" to what is wrong with it. */
export class Problem extends Error {
  /**
   * @param {string} text
   * @param {number} [status] of HTTP; 0: there was no answer
   * @param {Record<string, string>} [fields]
   * @param {any[]} [errors] each offending value as the server names it: {loc, message}
   * @param {any} [holder] who operates in place of this page, when it is that
   */
  constructor(text, status = 0, fields = {}, errors = [], holder = null) {
    super(text);
    this.status = status;
    this.fields = fields;
    this.errors = errors;
    this.holder = holder;
  }
}

const UNREACHABLE = "The server does not answer; nothing was changed.";
const CUT_OFF = "The connection broke before the rig answered: look what it does before you ask again.";
const BROKEN_OFF = "The server's answer broke off.";

/** ["gait", "sweep_deg"] and ["trajectory", "parameters", "points_mm", 3, 0] as a part and one of its fields. @param {(string | number)[]} [location] */
const dotted = (location) => (location ?? []).filter((part) => part !== "parameters").slice(0, 2).join(".");

/** @param {{loc: (string | number)[], message: string}[]} [errors] @returns {Record<string, string>} */
function fieldTexts(errors) {
  const pairs = (errors ?? []).map(({ loc, message }) => [dotted(loc), message]);
  return Object.fromEntries(pairs.filter(([field, text]) => field && text));
}

/** @param {Response} response */
async function problemOf(response) {
  const body = await response.json().catch(() => ({}));
  const text = body.detail || body.title || `The server answered ${response.status}.`;
  return new Problem(text, response.status, fieldTexts(body.errors), body.errors ?? [], body.holder);
}

let heed = /** @type {(problem: Problem) => void} */ (() => {});

/** @param {(problem: Problem) => void} listener hears of each refusal, whoever asked */
export function onRefusal(listener) {
  heed = listener;
}

/** Ends every request that waits for an answer. */
let ended = new AbortController();

/**
 * The connection is lost: what was asked before is not to be carried out when it comes back. A request that must arrive
 * all the same (`keepalive`: a stop) goes on.
 */
export function giveUpWaiting() {
  ended.abort();
  ended = new AbortController();
}

/** @param {Problem} problem */
function heeded(problem) {
  heed(problem);
  return problem;
}

/** @param {string} path below /api/v1 @param {RequestInit} options @returns {Promise<any>} the answer's JSON */
async function request(path, options) {
  const signal = options.signal ?? (options.keepalive ? null : ended.signal);
  const headers = { ...options.headers, "X-Client": CLIENT };
  const response = await fetch(`/api/v1${path}`, { ...options, headers, signal }).catch(() => {
    throw new Problem(signal?.aborted ? CUT_OFF : UNREACHABLE);
  });
  if (!response.ok) throw heeded(await problemOf(response));
  if (response.status === 204) return null;
  return response.json().catch(() => {
    throw new Problem(BROKEN_OFF);
  });
}

/** @param {string} method @returns {(path: string, body?: any, more?: RequestInit) => Promise<any>} */
const sending = (method) => (path, body = {}, more = {}) =>
  request(path, { method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), ...more });

/** @param {string} path */
export const read = (path) => request(path, { cache: "no-store" });
export const post = sending("POST");
export const put = sending("PUT");
export const patch = sending("PATCH");
/** @param {string} path */
export const remove = (path) => request(path, { method: "DELETE" });
