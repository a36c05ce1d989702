/** What this page calls itself, so that the rig can tell its requests from another tab's. */

/** Not `crypto.randomUUID`, which browsers keep from pages that came without TLS. */
const words = crypto.getRandomValues(new Uint32Array(4));

export const PAGE_ID = [...words].map((word) => word.toString(16).padStart(8, "0")).join("");
