/** Under the bar: a lost connection with its cause, and messages that stay until somebody dismisses them. */
import { reloadRigFile } from "../live/actions.js";
import { isSlow } from "../live/greeting.js";
import { live } from "../live/ticks.js";
import { Questions } from "../operator/question.js";
import { dismiss, useStore } from "../store.js";
import { clock } from "../units.js";
import { html, useEffect, useState } from "../view.js";

export function Notices({ retry }) {
  const messages = useStore((state) => state.messages);
  return html`
    <div class="notices">
      <${Outdated} />
      <${Connection} retry=${retry} />
      <${Slow} />
      <${Questions} />
      <${EditedRigFile} />
      ${messages.map((message) => html`<${Message} key=${message.id} ...${message} />`)}
    </div>
  `;
}

function Message({ id, text, severity, action }) {
  const act = () => {
    dismiss(id);
    action.act();
  };
  return html`
    <div class="notice" data-severity=${severity} role="alert">
      <p>${text}</p>
      ${action && html`<button type="button" onClick=${act}>${action.words}</button>`}
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

/** A page of the version before may misread what the server says; to stop the rig it is good enough. */
function Outdated() {
  const outdated = useStore((state) => state.outdated);
  if (!outdated) return null;
  return html`
    <div class="notice" data-severity="connection" role="alert">
      <p><strong>pivotrig was updated.</strong> This page is still of the version before: reload it. STOP works all the same.</p>
      <button type="button" onClick=${() => location.reload()}>Reload</button>
    </div>
  `;
}

function Connection({ retry }) {
  const { status, cause, retryAt } = useStore((state) => state.connection);
  if (status === "silent") return html`<div class="notice" data-severity="connection" role="status"><p><strong>Waiting:</strong> ${cause}. What is shown below is old.</p></div>`;
  if (status !== "lost") return null;
  return html`
    <div class="notice" data-severity="connection" role="alert">
      <p><strong>No connection:</strong> ${cause}. What is shown below is old. <${Countdown} until=${retryAt} /></p>
      <button type="button" onClick=${retry}>Try now</button>
    </div>
  `;
}

/** What comes in order and steadily may be old all the same. */
function Slow() {
  const late_s = useStore(({ connection }) => (isSlow(connection.late_ms) ? Math.round(connection.late_ms / 1000) : 0));
  if (late_s === 0) return null;
  return html`
    <div class="notice" data-severity="connection" role="status">
      <p><strong>Late:</strong> what is shown is ${late_s} s old, since the network to the rig is slow. Let the robot walk only where somebody sees it.</p>
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
  const age = live.receivedAt > 0 ? `It is ${ageWords((now - live.receivedAt) / 1000)} old. ` : "";
  return html`<span aria-hidden="true">${age}${seconds > 0 ? `Trying again in ${seconds} s.` : "Trying again…"}</span>`;
}

const ageWords = (seconds) => (seconds < 60 ? `${Math.round(seconds)} s` : `${clock(seconds)} min`);
