/** Under the bar: a lost connection with its cause, and messages that stay until somebody dismisses them. */
import { reloadRigFile } from "../live/actions.js";
import { dismiss, useStore } from "../store.js";
import { html, useEffect, useState } from "../view.js";

export function Notices({ retry }) {
  const messages = useStore((state) => state.messages);
  return html`
    <div class="notices">
      <${Connection} retry=${retry} />
      <${EditedRigFile} />
      ${messages.map((message) => html`<${Message} key=${message.id} ...${message} />`)}
    </div>
  `;
}

function Message({ id, text, severity }) {
  return html`
    <div class="notice" data-severity=${severity} role="alert">
      <p>${text}</p>
      <button class="quiet" type="button" onClick=${() => dismiss(id)}>Dismiss</button>
    </div>
  `;
}

/** What somebody has edited in the rig file is in force only when it is applied. */
function EditedRigFile() {
  const edited = useStore((state) => (state.rig?.file?.changed_on_disk ? state.rig.file.path : null));
  if (edited === null) return null;
  return html`
    <div class="notice" data-severity="info" role="alert">
      <p>The rig file ${edited} was changed on disk. The rig runs with the values from before.</p>
      <button type="button" onClick=${reloadRigFile}>Apply</button>
    </div>
  `;
}

function Connection({ retry }) {
  const { status, cause, retryAt } = useStore((state) => state.connection);
  if (status !== "lost") return null;
  return html`
    <div class="notice" data-severity="connection" role="alert">
      <p><strong>No connection:</strong> ${cause}. What is shown below is old. <${Countdown} until=${retryAt} /></p>
      <button type="button" onClick=${retry}>Try now</button>
    </div>
  `;
}

/** Not announced again at every second. */
function Countdown({ until }) {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 250);
    return () => clearInterval(timer);
  }, []);
  const seconds = Math.ceil((until - now) / 1000);
  return html`<span aria-hidden="true">${seconds > 0 ? `Trying again in ${seconds} s.` : "Trying again…"}</span>`;
}
