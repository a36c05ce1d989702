/** What of the rig's values differs between two times, by dotted names such as "camera.rate_Hz". Pure. */

const isGroup = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Nested objects as one, by dotted names; lists stay whole. */
export function flattened(value, prefix = "") {
  return Object.fromEntries(
    Object.entries(value).flatMap(([name, part]) =>
      isGroup(part) ? Object.entries(flattened(part, `${prefix}${name}.`)) : [[`${prefix}${name}`, part]]),
  );
}

/**
 * @param then as it was kept
 * @param {Record<string, any>} now as the server answers; `file` tells of the rig file on the disk and `notifications` of
 *   whom it calls: neither makes a run what it is
 * @returns {{name: string, then: any, now: any}[]}
 */
export function differencesOf(then, { file, notifications, ...now }) {
  const [before, after] = [flattened(then), flattened(now)];
  return Object.keys({ ...after, ...before })
    .filter((name) => JSON.stringify(before[name] ?? null) !== JSON.stringify(after[name] ?? null))
    .map((name) => ({ name, then: before[name], now: after[name] }));
}
