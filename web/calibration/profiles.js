/** Lighting profiles: the colours of the morning and of the evening, each under a name. */
import { patch, post, remove } from "../live/rest.js";
import { html, useState } from "../view.js";
import { Do, Outcome, useBusy, useChoice, useDisarmed } from "./parts.js";
import { learn, saving } from "./setup.js";

const PLACE = "profiles";

async function keep(words, call) {
  const answer = await saving(PLACE, words, call);
  await learn("vision");
  return answer !== null;
}

export function Profiles({ vision }) {
  const [doomed, setDoomed] = useState(null);
  const drop = async () => {
    await keep("Deleting", () => remove(`/vision/profiles/${encodeURIComponent(doomed)}`));
    setDoomed(null);
  };
  return html`
    <details class="more">
      <summary>Lighting profiles <span class="soft">${vision.profile}</span></summary>
      <p class="hint">For other light: save the colours in use under a name, and come back to them with one click.</p>
      <${Names} vision=${vision} ask=${setDoomed} />
      ${doomed !== null && html`
        <div class="guard" role="group" aria-label="Delete profile">
          <p>Delete the profile “${doomed}”?</p>
          <${Do} needsRest act=${drop}>Delete<//><${Do} act=${() => setDoomed(null)}>Keep<//>
        </div>`}
      <${SaveAs} />
      <${Outcome} place=${PLACE} />
    </details>
  `;
}

function Names({ vision, ask }) {
  const busy = useBusy();
  const disarmed = useDisarmed();
  const [chosen, choose] = useChoice(vision.profile, (name) => keep(`Changing to ${name}`, () => patch("/vision", { profile: name })));
  return html`
    <fieldset class="choices" disabled=${busy || !disarmed}>
      <legend class="unseen">Lighting profile in use</legend>
      ${vision.profiles.map((name) => html`
        <div class="choice-row" key=${name}>
          <label><input type="radio" name="lighting" checked=${name === chosen} onChange=${() => choose(name)} /><span>${name}</span></label>
          ${name !== vision.profile && html`<${Do} quiet needsRest label=${`Delete ${name}`} act=${() => ask(name)}>Delete<//>`}
        </div>
      `)}
    </fieldset>
  `;
}

function SaveAs() {
  const [name, setName] = useState("");
  const save = async () => {
    const wanted = name.trim();
    if (wanted && (await keep(`Saving ${wanted}`, () => post("/vision/profiles", { name: wanted })))) setName("");
  };
  const submit = (event) => {
    event.preventDefault();
    save();
  };
  return html`
    <form class="row" onSubmit=${submit}>
      <input type="text" aria-label="Name of the profile" placeholder="evening" maxlength="40" value=${name} onInput=${(event) => setName(event.target.value)} />
      <${Do} needsRest disabled=${!name.trim()} act=${save}>Save as<//>
    </form>
  `;
}
