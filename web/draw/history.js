/** What was done, to be undone and redone. Pure. */

/** Steps that can be taken back. */
const MOST = 200;

/**
 * @template T
 * @typedef {{past: T[], now: T, future: T[]}} History
 */

/** @template T @param {T} now @returns {History<T>} */
export const begun = (now) => ({ past: [], now, future: [] });

/**
 * The next step; what was undone before it cannot be redone any more.
 * @template T @param {History<T>} history @param {T} next @returns {History<T>}
 */
export const did = ({ past, now }, next) => ({ past: [...past, now].slice(-MOST), now: next, future: [] });

/** @template T @param {History<T>} history @returns {History<T>} */
export function undone(history) {
  const { past, now, future } = history;
  if (past.length === 0) return history;
  return { past: past.slice(0, -1), now: past[past.length - 1], future: [now, ...future] };
}

/** @template T @param {History<T>} history @returns {History<T>} */
export function redone(history) {
  const { past, now, future } = history;
  if (future.length === 0) return history;
  return { past: [...past, now], now: future[0], future: future.slice(1) };
}
