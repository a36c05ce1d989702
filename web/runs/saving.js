/** What is written about a run is saved when typing pauses, one request at a time, with the way back. */
import { Problem } from "../live/rest.js";
import { say } from "../store.js";
import { useEffect, useMemo, useState } from "../view.js";
import { edit } from "./inspected.js";

const TYPING_PAUSE_MS = 700;
const AT_REST = { draft: null, standing: { word: "" } };

/** One field of one run: `tell` hears of {draft: what the server has not got yet, or null, standing}. */
function createSaver(id, name, tell) {
  let state = AT_REST;
  /**
   * What is to be sent, and what Undo goes back to; undefined: it is an Undo itself.
   * @type {{next: any, before: any} | null}
   */
  let waiting = null;
  let before;
  let sending = false;
  let closed = false;
  let timer = 0;

  function change(part) {
    state = { ...state, ...part };
    if (!closed) tell(state);
  }

  /** value: what the server has. */
  function put(next, value, isUndo = false) {
    if (state.draft === null) before = value;
    waiting = { next, before: isUndo ? undefined : before };
    change({ draft: next });
  }

  async function flush(leaving = false) {
    clearTimeout(timer);
    if (waiting === null || (sending && !leaving)) return;
    const one = waiting;
    waiting = null;
    sending = true;
    change({ standing: { word: "saving" } });
    await send(one, leaving);
    sending = false;
    await flush();
  }

  async function send({ next, before }, leaving) {
    try {
      await edit(id, { [name]: next }, { keepalive: leaving });
      const standing = { word: before === undefined ? "undone" : "saved", saved: next, before };
      change({ standing, draft: waiting === null ? null : state.draft });
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      change({ standing: { word: "refused", error: problem.message } });
      if (closed) say(`What was written last as the ${name} of ${id} is not saved: ${problem.message}`);
    }
  }

  return {
    flush,
    type(next, value) {
      put(next, value);
      clearTimeout(timer);
      timer = setTimeout(flush, TYPING_PAUSE_MS);
    },
    take(of, value) {
      put(of(state.draft ?? value), value);
      flush();
    },
    undo(value) {
      put(state.standing.before, value, true);
      flush();
    },
    close() {
      closed = true;
      flush();
    },
  };
}

const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/**
 * @param value what the server has
 * @returns value: what is to be shown; standing: {word, error}; type(next): saved when typing pauses; take(of): saved
 *          at once, of(what is shown); flush(): saves what waits; undo(): back to what was there before, null while
 *          there is nothing to undo
 */
export function useSaved(id, name, value) {
  const [{ draft, standing }, show] = useState(AT_REST);
  const saver = useMemo(() => createSaver(id, name, show), []);
  useEffect(() => {
    // The page itself is closed just after something was typed.
    const leave = () => void saver.flush(true);
    addEventListener("pagehide", leave);
    return () => {
      removeEventListener("pagehide", leave);
      saver.close();
    };
  }, []);
  // What somebody else has written since is not undone.
  const isOurs = standing.word === "saved" && draft === null && standing.before !== undefined && same(standing.saved, value);
  return {
    value: draft ?? value, standing,
    type: (next) => saver.type(next, value),
    take: (of) => saver.take(of, value),
    flush: () => saver.flush(),
    undo: isOurs ? () => saver.undo(value) : null,
  };
}
