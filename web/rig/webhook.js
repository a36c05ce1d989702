/** Under the form of the notifications: one try of what is saved. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { tryWebhook, useRigPage } from "./settings.js";

export function Webhook() {
  const saved = useStore((state) => state.rig?.notifications?.webhook_url ?? "");
  const tested = useRigPage((page) => page.tested);
  const unsaved = useRigPage((page) => Object.keys(page.draft).some((path) => path.startsWith("notifications.")));
  const working = useRigPage((page) => page.working !== "");
  return html`
    <section class="rig-group" aria-label="Test of the webhook">
      <p class="hint">${saved
        ? `What happens is sent to ${saved} as JSON: {event, rig, time, message, url}.`
        : "Without an address nothing is sent, and no request leaves the lab’s network."}</p>
      <div class="row">
        <button type="button" disabled=${!saved || unsaved || working} onClick=${tryWebhook}>Send a test</button>
        ${unsaved && html`<span class="hint">Save the changes first.</span>`}
        ${tested && html`<span class="done" role="status">✓ Delivered; the other side answered ${tested.status}.</span>`}
      </div>
    </section>
  `;
}
