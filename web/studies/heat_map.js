/** Two axes as a map of cells: a table, so that it can be read without its colours and by a screen reader. */
import { fixed } from "../units.js";
import { Sideways } from "../sideways.js";
import { html } from "../view.js";
import { setAt } from "./projection.js";
import { colourAt, inkAt } from "./scale.js";
import { axisTitle, setText, valueText, withInterval } from "./words.js";

/** @param props sets of this panel; layout; scale (scaleOf); metric; caption in words or ""; best: id of the best set */
export function HeatMap({ sets, layout, scale, metric, caption, best }) {
  const { across, down } = layout;
  const rows = down?.values ?? [null];
  return html`
    <${Sideways} name="heat-scroll">
      <table class="heat">
        <caption>${caption}</caption>
        <thead>
          <tr><td></td><th class="heat-axis" scope="colgroup" colspan=${across.values.length}>${axisTitle(across)}</th></tr>
          <tr><th class="heat-axis" scope="col">${down ? axisTitle(down) : ""}</th>${across.values.map((value) => html`<th scope="col">${valueText(value)}</th>`)}</tr>
        </thead>
        <tbody>
          ${rows.map((row) => html`
            <tr>
              <th scope="row">${down ? valueText(row) : ""}</th>
              ${across.values.map((column) => html`<${Cell} set=${setAt(sets, across, column, down, row)} scale=${scale} metric=${metric} axes=${layout.axes} best=${best} />`)}
            </tr>
          `)}
        </tbody>
      </table>
    <//>
  `;
}

function Cell({ set, scale, metric, axes, best }) {
  if (!set) return html`<td class="heat-cell" data-state="absent"><span class="unseen">not in this study</span></td>`;
  const [, words, unit, digits] = metric;
  const known = Number.isFinite(set.mean) && scale !== null;
  const share = known ? scale.share(set.mean) : 0;
  const failed = set.failed > 0 ? `, ${set.failed} failed` : "";
  const title = `${setText(set.values, axes)}: ${words} ${withInterval(set, digits)} ${unit}, n = ${set.runs}${failed}`;
  return html`
    <td class="heat-cell" data-state=${known ? "known" : "waiting"} data-best=${set.set === best} title=${title}
      style=${known ? { background: colourAt(share), color: inkAt(share) } : {}}>
      <b>${known ? fixed(set.mean, digits) : "–"}</b><small>n ${set.runs}${set.failed > 0 ? html` <span title=${`${set.failed} failed`}>✕${set.failed}</span>` : ""}</small>
    </td>
  `;
}
