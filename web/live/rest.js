/** The REST calls: JSON in, JSON out, problem+json turned into one kind of error. */

/** A refusal by the server (or its silence), in words; `fields` maps "controller.gain" to what is wrong with it. */
export class Problem extends Error {
  constructor(text, status = 0, fields = {}) {
    super(text);
    this.status = status;
    this.fields = fields;
  }
}

const UNREACHABLE = "The server does not answer; nothing was changed.";
const BROKEN_OFF = "The server's answer broke off.";

/** ["gait", "sweep_deg"] and ["trajectory", "parameters", "points_mm", 3, 0] as a part and one of its fields. */
const dotted = (location) => (location ?? []).filter((part) => part !== "parameters").slice(0, 2).join(".");

function fieldTexts(errors) {
  const pairs = (errors ?? []).map(({ loc, message }) => [dotted(loc), message]);
  return Object.fromEntries(pairs.filter(([field, text]) => field && text));
}

async function problemOf(response) {
  const body = await response.json().catch(() => ({}));
  const text = body.detail || body.title || `The server answered ${response.status}.`;
  return new Problem(text, response.status, fieldTexts(body.errors));
}

async function request(path, options) {
  const response = await fetch(`/api/v1${path}`, options).catch(() => {
    throw new Problem(UNREACHABLE);
  });
  if (!response.ok) throw await problemOf(response);
  if (response.status === 204) return null;
  return response.json().catch(() => {
    throw new Problem(BROKEN_OFF);
  });
}

const sending = (method) => (path, body = {}, more = {}) =>
  request(path, { method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), ...more });

export const read = (path) => request(path, { cache: "no-store" });
export const post = sending("POST");
export const put = sending("PUT");
export const patch = sending("PATCH");
export const remove = (path) => request(path, { method: "DELETE" });
