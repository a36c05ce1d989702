/** The rarer fields: order, seed, length of a run, when to end early, and what a campaign on a rig waits for. */
import { useStore } from "../store.js";
import { html } from "../view.js";
import { Choice, Entry } from "./entry.js";
import { METRICS } from "./words.js";

export function Limits({ rest, order }) {
  return html`
    ${rest.design === "latin" && html`<div class="fields"><${Entry} path=${["latin", "sets"]} title="Sets" /></div>`}
    ${rest.design === "tune" && html`<${Tune} />`}
    <details class="study-more">
      <summary>Order, length and limits</summary>
      <div class="fields">
        <${Choice} path=${["order"]} title="Order" options=${order} hint="So that a drift of the rig does not look like an effect." />
        <${Entry} path=${["seed"]} title="Seed" hint="Of the order, the sets of a Latin hypercube, and every run." />
        <${Entry} path=${["passes"]} title="Passes a run" placeholder="1" />
        <${Entry} path=${["duration_s"]} title="A run ends after" unit="s" placeholder="its path" />
        <${Entry} path=${["stop", "failed_in_a_row"]} title="Ends after failures in a row" placeholder="3" />
        <${Entry} path=${["stop", "hours"]} title="Ends after" unit="h" placeholder="never" />
        <${Entry} path=${["stop", "half_width_percent"]} title="A set is known well enough at ±" unit="%" placeholder="never" hint="No more repeats of a set once the 95 % interval of its mean error is narrower." />
      </div>
    </details>
    ${rest.on === "rig" ? html`<${OnRig} />` : html`<${OnBatch} />`}
  `;
}

function Tune() {
  return html`
    <div class="fields">
      <${Entry} path=${["tune", "budget"]} title="Runs in all" placeholder="50" />
      <${Entry} path=${["tune", "first"]} title="Runs before it learns" placeholder="12" />
      <${Entry} path=${["tune", "at_once"]} title="Runs chosen together" placeholder="4" />
      <${Choice} path=${["tune", "minimise"]} title="Smallest" options=${METRICS.filter(([name]) => name !== "steps").map(([name, words]) => [name, words])} />
    </div>
  `;
}

function OnBatch() {
  return html`
    <details class="study-more">
      <summary>Where a run starts</summary>
      <div class="fields">
        <${Entry} path=${["start", "scatter_mm"]} title="Scatter of the place" unit="mm" placeholder="0" />
        <${Entry} path=${["start", "scatter_deg"]} title="Scatter of the heading" unit="deg" placeholder="0" />
      </div>
    </details>
  `;
}

function OnRig() {
  const simulated = useStore((state) => state.tick?.simulated);
  return html`
    <details class="study-more">
      <summary>Between two runs</summary>
      <p class="hint">The robot walks back to the start by itself before each run.${simulated ? "" : " Current flows through real coils while nobody looks; read SAFETY.md first."}</p>
      <div class="fields">
        <${Entry} path=${["rig", "start_within_mm"]} title="Back at the start within" unit="mm" placeholder="1" />
        <${Entry} path=${["rig", "start_within_deg"]} title="and" unit="deg" placeholder="5" />
        <${Entry} path=${["rig", "rest_s"]} title="Rest before a run" unit="s" placeholder="1" />
        <${Entry} path=${["rig", "attempts"]} title="Attempts at a run" placeholder="3" />
        <${Entry} path=${["rig", "cool_to_percent"]} title="Let the coils cool to" unit="%" placeholder="60" />
        <${Entry} path=${["rig", "wait_minutes"]} title="Wait for a person" unit="min" placeholder="30" />
      </div>
    </details>
  `;
}
