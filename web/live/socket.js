/** A WebSocket that comes back by itself, with back-off, and says why it went away. */

const FIRST_DELAY_MS = 400;
const LONGEST_DELAY_MS = 8000;
const GROWTH = 1.7;

/** @param {string} path */
const url = (path) => `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`;

/** @param {CloseEvent} event @returns {string} in words */
function causeOf(event) {
  if (!navigator.onLine) return "this device is offline";
  if (event.reason) return event.reason;
  if (event.code === 1001 || event.code === 1012) return "the server is shutting down";
  return "the server does not answer";
}

/**
 * @param {string} path
 * @param {{message: (data: any, send: (text: string) => void) => void, open?: () => void,
 *          lost?: (cause: string, retryAt: number, code: number | null) => void}} handlers
 * @returns {{close: () => void, retry: () => void, abandon: (cause: string) => void, send: (text: string) => void}} send: while it is open
 */
export function keepOpen(path, handlers) {
  /** @type {WebSocket | null} */
  let socket = null;
  let delay = FIRST_DELAY_MS;
  let timer = /** @type {any} */ (0);
  let closed = false;

  function connect() {
    clearTimeout(timer);
    const own = (socket = new WebSocket(url(path)));
    own.onopen = () => {
      if (own === socket) handlers.open?.();
    };
    own.onmessage = (event) => {
      if (own !== socket) return;
      delay = FIRST_DELAY_MS;
      handlers.message(event.data, (text) => own.readyState === WebSocket.OPEN && own.send(text));
    };
    own.onclose = (event) => own === socket && lose(causeOf(event), event.code);
  }

  /** @param {string} cause @param {number | null} code */
  function lose(cause, code = null) {
    socket = null;
    if (closed) return;
    const wait = delay * (0.8 + 0.4 * Math.random());
    delay = Math.min(delay * GROWTH, LONGEST_DELAY_MS);
    timer = setTimeout(connect, wait);
    handlers.lost?.(cause, performance.now() + wait, code);
  }

  /** A dead network can keep a socket in its closing handshake for minutes: it is let go at once. @param {string} cause */
  function abandon(cause) {
    if (socket === null) return;
    const old = socket;
    lose(cause);
    old.close();
  }

  function close() {
    closed = true;
    clearTimeout(timer);
    const old = socket;
    socket = null;
    old?.close();
  }

  connect();
  return { close, abandon, send: (text) => socket?.readyState === WebSocket.OPEN && socket.send(text), retry: () => socket === null && !closed && connect() };
}
