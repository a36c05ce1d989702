/** Tells the server that somebody can see this page: whoever operates and is not heard of may lose control. */

/** The server waits for two of them, ms. */
const BEAT_MS = 1000;

/** @param {(text: string) => void} send by the telemetry stream, while that is open @returns {() => void} beats at once */
export function keepBeating(send) {
  let isLeaving = false;
  const tell = () => send(JSON.stringify({ type: "heartbeat", visible: !document.hidden }));
  setInterval(() => document.hidden || tell(), BEAT_MS);
  // A page that is left is hidden as well; one that is only loaded anew comes back before the server has waited.
  addEventListener("pagehide", () => (isLeaving = true));
  addEventListener("pageshow", () => (isLeaving = false));
  document.addEventListener("visibilitychange", () => isLeaving || tell());
  return tell;
}
