/** On the log's tab: how many faults are open, or how many warnings and faults nobody has looked at yet. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { unseen } from "./words.js";

export function Badge() {
  const open = useStore((state) => state.tick?.faults?.length ?? 0);
  const fresh = useStore((state) => (state.tab === "log" ? 0 : unseen(state.events, state.log.seen)));
  if (open > 0) return html` <span class="count" data-severity="fault">${open}<span class="unseen"> open</span></span>`;
  if (fresh > 0) return html` <span class="count">${fresh}<span class="unseen"> new</span></span>`;
  return null;
}
