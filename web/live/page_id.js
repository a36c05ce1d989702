/** What this page calls itself, so that the rig can tell its requests from another tab's. */

/** Not `crypto.randomUUID`, which browsers keep from pages that came without TLS. */
export const anyId = () => [...crypto.getRandomValues(new Uint32Array(4))].map((word) => word.toString(16).padStart(8, "0")).join("");

export const PAGE_ID = anyId();
