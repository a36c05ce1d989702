/** Parts of the page that are loaded when they are first looked at, so that what is seen first stands sooner. */
import { html, useEffect, useState } from "../view.js";

/**
 * A component that loads itself. Its modules come once, for all places where it stands.
 *
 * @param {() => Promise<any>} load () => import("…").then((module) => module.Part)
 * @param {string} what "the studies": what is said to come, or not to have come
 * @param {string} [place] class of what is said meanwhile, where the page has a place of its own for it
 */
export function lazy(load, what, place = "") {
  let Part = null;
  return function Lazy(props) {
    const [failure, setFailure] = useState(null);
    const [tries, setTries] = useState(0);
    const [, redraw] = useState(false);
    useEffect(() => {
      if (Part !== null) return undefined;
      let wanted = true;
      load().then(
        (loaded) => {
          Part = loaded;
          if (wanted) redraw(true);
        },
        async () => {
          const outdated = await isOutdated();
          if (wanted) setFailure({ outdated });
        },
      );
      return () => void (wanted = false);
    }, [tries]);
    const again = () => {
      setFailure(null);
      setTries(tries + 1);
    };
    if (Part !== null) return html`<${Part} ...${props} />`;
    if (failure !== null) return html`<${Failure} what=${what} place=${place} outdated=${failure.outdated} again=${again} />`;
    return html`<p class=${`hint padded coming ${place}`}>Loading ${what}…</p>`;
  };
}

function Failure({ what, place, outdated, again }) {
  const [words, button, act] = outdated
    ? ["pivotrig was updated since this page was opened; this part fits only the new page.", "Reload the page", () => location.reload()]
    : [`The server did not send ${what}.`, "Try again", again];
  return html`<p class=${`padded not-come ${place}`} role="alert">${words} <button type="button" onClick=${act}>${button}</button></p>`;
}

/** A server of another version has not this page's files: its modules must not be mixed with ours. */
async function isOutdated() {
  try {
    return (await fetch(import.meta.url, { method: "HEAD", cache: "no-store" })).status === 404;
  } catch {
    // Silence says nothing of versions.
    return false;
  }
}
