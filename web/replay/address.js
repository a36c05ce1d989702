/** Which runs the page's address says: `#replay=ID` or `#replay=ID,ID2`, so that reload, back and forward keep them. */

const HEAD = "#replay=";
/** Two are compared; more could not be told apart in one picture. */
export const MOST = 2;

/** @returns ids of runs; none when the address is that of the rig itself */
export function idsInAddress() {
  if (!location.hash.startsWith(HEAD)) return [];
  const ids = location.hash.slice(HEAD.length).split(",").map(decoded).filter(Boolean);
  return [...new Set(ids)].slice(0, MOST);
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch (problem) {
    if (!(problem instanceof URIError)) throw problem;
    return "";
  }
}

const home = () => `${location.pathname}${location.search}`;

/** Goes to another address without loading the page anew; `history.back()` returns. */
export function goTo(ids) {
  const hash = ids.length > 0 ? HEAD + ids.map(encodeURIComponent).join(",") : "";
  if (hash !== location.hash) history.pushState(null, "", home() + hash);
}

/** Forgets the address that has turned out to lead nowhere. */
export const leaveQuietly = () => history.replaceState(null, "", home());

/** Tells of back, forward and an address that somebody types. */
export function onAddress(listener) {
  addEventListener("popstate", listener);
  addEventListener("hashchange", listener);
}
