/** The values of one section as fields; a list of numbers has a field each. */
import { Field } from "../forms/form.js";
import { useStore } from "../store.js";
import { html } from "../view.js";
import { at, entryValue, inWords, isSame, titleAt, withEntry } from "./fields.js";
import { put, useRigPage } from "./settings.js";

/** @param {{group: import("./fields.js").Group}} props */
export function Group({ group }) {
  const single = group.values.filter(({ entries }) => entries.length === 1);
  const several = group.values.filter(({ entries }) => entries.length > 1);
  return html`
    <section class="rig-group" aria-label=${group.title || undefined}>
      ${group.title && html`<h3>${group.title}</h3>`}
      ${group.title && group.description && html`<p class="hint">${group.description}</p>`}
      ${single.length > 0 && html`<div class="fields">${single.map((value) => html`<${Single} key=${value.path} value=${value} />`)}</div>`}
      ${several.map((value) => html`<${Several} key=${value.path} value=${value} />`)}
    </section>
  `;
}

const useOverridden = (path) => useStore((state) => Boolean(state.rig?.file?.overridden?.includes(path)));

function useValue(path) {
  const now = useStore((state) => at(state.rig, path));
  const drafted = useRigPage((page) => (path in page.draft ? { value: page.draft[path] } : null));
  return { now, value: drafted ? drafted.value : now };
}

const WAITS = "Not saved yet";
const NO_MARK = null;

/** Says beside a changed value what the rig has. */
const standing = (now, value, unit) =>
  isSame(now, value) ? NO_MARK : { state: "waits", words: `${WAITS}; the rig has ${inWords(now, unit)}` };

function Single({ value }) {
  const { path, unit, entries: [entry] } = value;
  const { now, value: shown } = useValue(path);
  if (useOverridden(path)) return null;
  return html`<${Field} id=${`rig.${path}`} of=${ofGroup(path)} form=${entry.form} value=${shown} standing=${standing(now, shown, unit)} onChange=${(next) => put(path, next)} />`;
}

function Several({ value }) {
  const { path, title, description, unit, entries } = value;
  const { now, value: whole } = useValue(path);
  const isSet = entries[0].member !== null;
  if (useOverridden(path)) return null;
  return html`
    <fieldset class="rig-several" data-set=${isSet}>
      <legend class=${isSet ? "" : "unseen"}>${title}</legend>
      <div class="fields">
        ${entries.map((entry) => html`
          <${Field} key=${entry.member ?? entry.index} id=${`rig.${path}.${entry.member ?? entry.index}`} form=${{ ...entry.form, description: "" }}
            value=${entryValue(whole, entry)} standing=${standing(entryValue(now, entry), entryValue(whole, entry), unit)}
            onChange=${(next) => put(path, withEntry(whole, entry, next, value))} />
        `)}
      </div>
      ${description && html`<p class="hint">${description}</p>`}
    </fieldset>
  `;
}

/** "rig.limits", for the help. */
const ofGroup = (path) => `rig.${path.split(".").slice(0, -1).join(".")}`;

/** What this start of the server goes without: it cannot be changed here and now. */
export function Overridden({ section, sections }) {
  const paths = useStore((state) => (state.rig?.file?.overridden ?? []).filter((path) => path.startsWith(`${section}.`)).join(" "));
  const simulated = useStore((state) => Boolean(state.rig?.simulated));
  if (paths === "") return null;
  const titles = paths.split(" ").map((path) => titleAt(sections, path).title.split(" · ").at(-1));
  return html`<p class="hint rig-note">${titles.join(", ")}: not as in the file, since this server was started ${simulated ? "with --sim, which simulates camera and board" : "otherwise"}.</p>`;
}
