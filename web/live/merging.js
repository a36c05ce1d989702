/** Two people edit the settings of the next run at the same moment: what becomes of it. Pure. */

export const PARTS = /** @type {const} */ (["controller", "trajectory", "gait"]);

/** @param {unknown} one @param {unknown} other */
export const isSame = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/**
 * @template {Record<typeof PARTS[number], unknown>} S
 * @param {S} base what both began with @param {S} mine @param {S} theirs
 * @returns {{merged: S, taken: string[], kept: string[]}} taken: parts that only they changed; kept: parts that both
 *          changed, where mine stays since somebody is typing it
 */
export function merge(base, mine, theirs) {
  const changed = PARTS.filter((part) => !isSame(theirs[part], base[part]) && !isSame(theirs[part], mine[part]));
  const taken = changed.filter((part) => isSame(mine[part], base[part]));
  const kept = changed.filter((part) => !taken.includes(part));
  return { merged: { ...mine, ...Object.fromEntries(taken.map((part) => [part, theirs[part]])) }, taken, kept };
}
