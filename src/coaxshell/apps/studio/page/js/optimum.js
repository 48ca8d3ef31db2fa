// What an optimisation came to: baseline against best with units, convergence or front, and any of its designs made the current system.
import { request } from "./api.js";
import { SETTINGS, above, frame } from "./curves.js";
import { el, toast } from "./dom.js";
import { spelt } from "./study_fields.js";
import { colour } from "./theme.js";
import { inComparison, percent, prefixed, show as text } from "./units.js";
import { told } from "./words.js";

const NAMES = { "cma-es": "CMA-ES", "differential-evolution": "differential evolution", nsga2: "NSGA-II", gradient: "gradients" };

export function show(result, box, { id, opened }) {
  const { targets, variables, front, feasible, best } = result;
  const baseline = { values: variables.map((one) => one.baseline), targets: targets.map((one) => one.baseline) };
  let chosen = front.find((one) => one.number === best.number) ?? { number: best.number, values: variables.map((one) => one.best), targets: targets.map((one) => one.best) };
  const table = el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "Baseline and best" });
  const plot = el("div", { id: "study-plot", class: "study-plot" });
  const select = front.length > 1 && el("select", { id: "study-design", onchange: () => choose(front.find((one) => one.number === Number(select.value))) }, ...front.map((one) => el("option", { value: one.number, selected: one.number === chosen.number }, goals(result).map((k) => text(one.targets[k], targets[k].unit)).join(", "))));
  const use = el("button", { type: "button", class: "main", id: "study-use", disabled: !best.system, onclick: () => adopt() }, "Use this system");

  async function adopt() {
    try {
      const answer = await request(`/api/jobs/${id}/designs/${chosen.number}`);
      if (answer.ok) { opened(answer, "an optimised design"); toast("This is the current system now; Undo takes it back."); } else toast(told(answer.problem));
    } catch (failure) { toast(told(failure)); }
  }
  function choose(one) {
    chosen = one;
    if (select) select.value = one.number;
    fill();
    redraw();
    adopt();
  }
  const fill = () => table.replaceChildren(comparison(result, baseline, chosen, front.length > 1));
  const redraw = () => (front.length || targets.filter((one) => one.goal).length > 1 ? drawFront : drawHistory)(plot, result, chosen, choose);

  box.replaceChildren(el("h3", {}, "Found"), el("p", { class: "note", id: "study-summary" }, summary(result)), ...notes(result),
    el("div", { class: "buttons adopt" }, use, select && el("label", { class: "inline" }, el("span", {}, `Design of the front (${goals(result).map((k) => spelt(targets[k].name)).join(", ")})`), select)),
    el("div", { class: "found" }, table, plot));
  fill();
  redraw();
  return feasible || best.system ? redraw : () => {};
}

const goals = ({ targets }) => targets.flatMap((one, k) => (one.goal ? [k] : []));

function summary({ evaluations, method, resolution: { modes, time_step }, front }) {
  return `${evaluations} design${evaluations === 1 ? "" : "s"} tried by ${NAMES[method] ?? method} at ${modes} orders, step ${text(time_step, "")} a/c${front.length ? `; ${front.length} of them on the front: none is better in both` : ""}.`;
}

function notes({ feasible, warnings }) {
  const all = [...(feasible ? [] : ["No design keeps all limits: the one that comes nearest is shown."]), ...warnings.map((one) => one.charAt(0).toUpperCase() + one.slice(1))];
  return all.length ? [el("ul", { class: "warnings", "aria-label": "Warnings" }, ...all.map((one) => el("li", {}, one)))] : [];
}

// ---- the table

function comparison({ targets, variables }, baseline, chosen, isFront) {
  const number = (value, unit) => el("td", { class: "number" }, typeof value === "string" ? value : text(value, unit === "1" ? "" : unit).replace("\u202f", " "));
  const line = (one, before, after) => {
    const change = typeof after === "number" && typeof before === "number" ? percent(after, before) : null;
    const better = one.goal && change !== null && Math.abs(change) >= 0.05 ? ((change < 0) === (one.goal === "minimise") ? "better" : "worse") : "";
    return el("tr", { title: one.label }, el("th", { scope: "row" }, spelt(one.name), ...words(one).map((word) => el("small", {}, word))), number(before, one.unit), number(after, one.unit), el("td", { class: `number ${better}` }, inComparison(change)));
  };
  const rows = (title, list, key) => el("tbody", {}, el("tr", {}, el("th", { scope: "rowgroup", colspan: 4 }, title)), ...list.map((one, k) => line(one, baseline[key][k], chosen[key][k])));
  return el("table", { class: "peaks optimum" }, el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Quantity"), ...["Baseline", isFront ? "Chosen" : "Best", "Change"].map((word) => el("th", { scope: "col", class: "number" }, word)))),
    rows("Asked for", targets, "targets"), rows("Changed", variables, "values"));
}

function words({ goal, limits = [], unit }) {
  return [...(goal ? [goal === "minimise" ? "to be small" : "to be large"] : []), ...limits.map(({ sign, value }) => `${sign === "<=" ? "at most" : "at least"} ${text(value, unit === "1" ? "" : unit)}`)];
}

// ---- the plots

const scaled = (values, factor) => values.map((value) => (value === null ? null : value / factor));
const largest = (values) => Math.max(...values.map((value) => Math.abs(value ?? 0)), 0);
const axisName = (one, scale) => `${spelt(one.name)}${scale.unit && scale.unit !== "1" ? ` (${scale.unit})` : ""}`;
const dots = (name, x, y, symbol, tint, more = {}) => ({ type: "scatter", mode: "markers", name, x, y, marker: { size: 5, symbol, color: colour(tint), ...more } });

function describe(plot, words) {
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", words);
}

// Every design and the best so far over the evaluations; the range leaves out what is far worse than all that matters.
function drawHistory(plot, { targets, history }) {
  const [goal] = targets.filter((one) => one.goal), [values] = history.objectives;
  const scale = prefixed(goal.unit, largest([goal.baseline, ...history.best])), known = values.filter((value) => value !== null).sort((a, b) => a - b);
  const of = (kept) => values.map((value, i) => (history.feasible[i] === kept ? value : null)), count = values.map((_, i) => i + 1);
  const { style, axis, layout } = frame({ hovermode: "closest", showlegend: true });
  const hover = `design %{x}: %{y:.4~g} ${scale.unit}<extra></extra>`, line = (name, x, y, tint, dash, shape) => ({ type: "scatter", mode: "lines", name, x, y, hovertemplate: hover, line: { color: colour(tint), width: dash === "solid" ? 2 : 1.4, dash, shape } });
  const traces = [{ ...dots("designs", count, scaled(of(true), scale.factor), "circle", "bare"), hovertemplate: hover },
    ...(of(false).every((value) => value === null) ? [] : [{ ...dots("limit broken", count, scaled(of(false), scale.factor), "x-thin-open", "bad"), hovertemplate: hover }]),
    line("baseline", [1, count.length], scaled([goal.baseline, goal.baseline], scale.factor), "text", "dot"), line("best so far", count, scaled(history.best, scale.factor), "current", "solid", "hv")];
  const ends = [goal.baseline, ...history.best, known[Math.floor(0.8 * (known.length - 1))]].filter((value) => value !== null && value !== undefined);
  const low = Math.min(...ends, ...known.slice(0, 1)), high = Math.max(...ends), margin = 0.08 * (high - low) || 0.1 * Math.abs(high) || 1;
  Object.assign(layout, { legend: above(style), margin: { l: 72, r: 12, t: 30, b: 44 }, xaxis: { ...axis, zeroline: false, title: { text: "designs tried", font: style }, range: [0, count.length + 1] },
    yaxis: { ...axis, zeroline: false, title: { text: axisName(goal, scale), font: style }, range: [(low - margin) / scale.factor, (high + margin) / scale.factor] } });
  describe(plot, `${spelt(goal.name)} of each design tried; the best so far falls to ${text(history.best.at(-1), goal.unit)}`.replace("falls to –", "is none"));
  window.Plotly.react(plot, traces, layout, SETTINGS);
}

// All designs by their two objectives, the front among them; a click on one of the front makes it the current system.
function drawFront(plot, result, chosen, choose) {
  const { targets, history, front } = result, [i, j] = goals(result), [x, y] = [targets[i], targets[j]];
  const scales = [x, y].map((one, k) => prefixed(one.unit, largest([one.baseline, ...front.map(({ targets: all }) => all[k ? j : i])])));
  const of = (one) => [one.targets[i] / scales[0].factor, one.targets[j] / scales[1].factor];
  const best = new Set(front.map((one) => one.number));
  const kept = history.objectives.map((values, k) => scaled(values.map((value, n) => (history.feasible[n] && !best.has(n) ? value : null)), scales[k].factor));
  const { style, axis, layout } = frame({ hovermode: "closest", showlegend: true });
  const hover = `%{x:.4~g} ${scales[0].unit}, %{y:.4~g} ${scales[1].unit}<extra></extra>`;
  const traces = [{ ...dots("designs", ...kept, "circle", "bare", { opacity: 0.55 }), hoverinfo: "skip" },
    { ...dots("front", front.map((one) => of(one)[0]), front.map((one) => of(one)[1]), "circle", "current", { size: 8 }), mode: "lines+markers", line: { color: colour("current"), width: 1.2 }, customdata: front.map((one) => one.number), hovertemplate: `${hover.replace("<extra>", "; click to use it<extra>")}` },
    { ...dots("baseline", [x.baseline === null ? null : x.baseline / scales[0].factor], [y.baseline === null ? null : y.baseline / scales[1].factor], "diamond", "text", { size: 9 }), hoverinfo: "skip" },
    ...(chosen.targets[i] === null ? [] : [{ ...dots("chosen", [of(chosen)[0]], [of(chosen)[1]], "circle-open", "pinned", { size: 14, line: { width: 2.5, color: colour("pinned") } }), hoverinfo: "skip" }])];
  Object.assign(layout, { legend: above(style), margin: { l: 72, r: 12, t: 30, b: 44 }, xaxis: { ...axis, zeroline: false, title: { text: axisName(x, scales[0]), font: style }, ...within(front, x, i, scales[0]) }, yaxis: { ...axis, zeroline: false, title: { text: axisName(y, scales[1]), font: style }, ...within(front, y, j, scales[1]) } });
  describe(plot, `Front of ${spelt(x.name)} against ${spelt(y.name)}, ${front.length} designs; choose one in the list above`);
  window.Plotly.react(plot, traces, layout, SETTINGS);
  if (plot.wired) return;
  plot.wired = true;
  plot.on("plotly_click", ({ points }) => { const one = front.find(({ number }) => number === points[0].customdata); if (one) choose(one); });
}

// The range that shows front and baseline well; what is far worse than both lies outside.
function within(front, { baseline }, k, { factor }) {
  const values = [baseline, ...front.map(({ targets }) => targets[k])].filter((value) => value !== null);
  if (!values.length) return {};
  const low = Math.min(...values), high = Math.max(...values), margin = 0.15 * (high - low) || 0.1 * Math.abs(high) || 1;
  return { range: [(low - margin) / factor, (high + margin) / factor] };
}
