/** Gives a text of the page's own to the person as a file. */

/** @param {string} name of the file @param {string | string[]} text whole, or its parts @param {string} type such as "text/csv" */
export function download(name, text, type) {
  const address = URL.createObjectURL(new Blob([text].flat(), { type }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  // Not before the browser has begun to read it.
  setTimeout(() => URL.revokeObjectURL(address));
}
