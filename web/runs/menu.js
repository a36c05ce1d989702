/** A button with links behind it: plain links, so that the browser shows how far a download is. */
import { html, useEffect, useRef } from "../view.js";

/**
 * @param {Object} props
 * @param {string} props.title
 * @param {[address: string, words: string][]} props.links
 * @param {string} [props.why] why there is nothing to choose yet
 * @param {string} [props.remark] beneath the links
 */
export function DownloadMenu({ title, links, why = "", remark = "" }) {
  const menu = useRef(null);
  useCloseOutside(menu);
  if (why) return html`<button type="button" disabled title=${why}>${title}</button>`;
  const close = () => (menu.current.open = false);
  return html`
    <details class="menu" ref=${menu}>
      <summary>${title}</summary>
      <ul>
        ${links.map(([address, words]) => html`<li key=${address}><a href=${address} download onClick=${close}>${words}</a></li>`)}
        ${remark && html`<li class="hint">${remark}</li>`}
      </ul>
    </details>
  `;
}

/** A click or the focus elsewhere closes it. */
function useCloseOutside(menu) {
  useEffect(() => {
    const leave = (event) => menu.current && !menu.current.contains(event.target) && (menu.current.open = false);
    addEventListener("pointerdown", leave);
    addEventListener("focusin", leave);
    return () => {
      removeEventListener("pointerdown", leave);
      removeEventListener("focusin", leave);
    };
  }, []);
}
