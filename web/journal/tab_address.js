/** The open tab in the page's address. Pure. */

const NAME = "tab";
/** What a page without a word of it shows. */
export const FIRST = "runs";

/** @param {string} href @param {string[]} names @returns {string | null} null where it names none that there is */
export function tabIn(href, names) {
  const named = new URL(href).searchParams.get(NAME);
  return named !== null && names.includes(named) ? named : null;
}

/** The same address with another tab; what else is in it stays. @param {string} href @param {string} tab */
export function addressWith(href, tab) {
  const url = new URL(href);
  if (tab === FIRST) url.searchParams.delete(NAME);
  else url.searchParams.set(NAME, tab);
  return url.href;
}
