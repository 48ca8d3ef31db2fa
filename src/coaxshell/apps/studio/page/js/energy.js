// Where the energy goes: stores and losses stacked, the work done on the outer shell as a line over them; colours and order are the library's.
import { request } from "./api.js";
import * as cuts from "./cuts.js";
import { by, el } from "./dom.js";
import { SETTINGS, UNITS, above, frame } from "./curves.js";
import { finished } from "./events.js";
import { colour } from "./theme.js";
import { prefixed, show } from "./units.js";
import { told } from "./words.js";

let shown = null, wanted = null, work = null; // what is drawn: { answer, run }; the run asked for; its job

export async function draw(run, unit, sure = false) {
  if (shown?.run === run.run) return chart(shown.answer, run, unit);
  if (wanted === run.run) return null;
  if (run.stations && !sure) return offered(run, unit);
  work?.cancel();
  wanted = run.run;
  const mine = (work = finished({ kind: "energy", run: run.run, every: Math.ceil(run.arrays.time.values.length / 200) }, (job) => work === mine && progress(job)));
  progress({ fraction: 0 });
  try {
    const job = await mine.promise;
    const answer = await request(`/api/jobs/${job.id}/result`);
    if (work !== mine) return null;
    shown = { answer, run: run.run };
    chart(answer, run, unit);
  } catch (failure) {
    if (work === mine) forget(failure.cancelled ? el("p", { class: "empty" }, "Cancelled.") : el("p", { class: "problem" }, told(failure)));
  }
  return null;
}

// In three dimensions it takes long, and waits until it is asked for.
async function offered(run, unit) {
  work?.cancel();
  work = wanted = null;
  const box = by("energy"), ask = el("button", { type: "button", id: "energy-ask", onclick: () => { box.focus(); draw(run, unit, true); } }, "Integrate the energy over the whole length"), line = el("div", { class: "bar status", id: "energy-state" }, ask);
  by("energy-plot")?.classList.add("old");
  by("energy-state")?.remove();
  box.prepend(line);
  try {
    const { energy, energy_refused: refused } = await cuts.costsOf(run);
    if (energy) ask.textContent += `, about ${cuts.inTime(energy.seconds)}`;
    else line.replaceChildren(el("p", { class: "note" }, told(refused)));
  } catch (failure) { line.replaceChildren(el("p", { class: "problem" }, told(failure))); }
  return null;
}

export function forget(instead = null) {
  shown = wanted = work = null;
  if (instead) by("energy").replaceChildren(instead);
}

// How far the balance of a new state is; that of the one before stays, dimmed.
function progress({ fraction }) {
  const box = by("energy"), plot = by("energy-plot"), text = `Integrating the fluids’ energy: ${Math.round(100 * (fraction ?? 0))}\u202f%`;
  plot?.classList.add("old");
  if (by("energy-ask")) by("energy-state").remove();
  if (!by("energy-state")) box.prepend(el("div", { class: "bar status", id: "energy-state" }, el("p", { class: "note", role: "status" }), el("button", { type: "button", class: "quiet", onclick: () => work?.cancel() }, "Cancel")));
  by("energy-state").firstChild.textContent = text;
}

// Stores and losses by what they belong to, in the library's order; a group is lost for good when all of it is.
function groups(answer) {
  return answer.groups.map(({ name, colour: tint }) => {
    const mine = answer.entries.filter(({ role, group }) => group === name && (role === "store" || role === "loss"));
    const values = new Float64Array(answer.arrays.time.values.length);
    for (const entry of mine) answer.arrays[entry.name].values.forEach((value, i) => { values[i] += value; });
    return { label: name, tint, lost: mine.every(({ role }) => role === "loss"), values };
  }).filter(({ values }) => values.some((value) => value !== 0));
}

function chart(answer, run, unit) {
  const { name, of } = UNITS[unit], time = answer.arrays.time.values.map((value) => value * of(run)), parts = groups(answer), done = answer.arrays.exterior_work, total = done?.values;
  const largest = Math.max(...[...parts.map(({ values }) => values), total ?? []].flatMap((values) => Array.from(values, Math.abs)));
  const joule = done?.unit ?? "J/m", scale = prefixed(joule, largest), y = (values, part) => Float32Array.from(values, (value) => part(value) / scale.factor);
  // What is given back (actuators that drive) is stacked below zero, or it would hide its neighbours.
  const traces = parts.flatMap(({ values, label, tint, lost }) => [["above", (value) => Math.max(value, 0)], ["below", (value) => Math.min(value, 0)]].filter(([, part]) => values.some((value) => part(value))).map(([stackgroup, part], i) => ({
    x: time, y: y(values, part), name: label, legendgroup: label, showlegend: !i, stackgroup, type: "scatter", mode: "lines", line: { width: 0.5, color: tint },
    fillcolor: tint, fillpattern: lost ? { shape: "/", size: 6, solidity: 0.25 } : undefined, hovertemplate: `%{y:.3g} ${scale.unit}<extra>${label}</extra>`,
  })));
  if (total) traces.push({ x: time, y: y(total, (value) => value), name: "work of the exterior pressure", type: "scatter", mode: "lines", line: { color: colour("text"), width: 1.6 }, hovertemplate: `%{y:.3g} ${scale.unit}<extra></extra>` });
  const { style, axis, layout } = frame({ showlegend: true, height: 380, hovermode: "x unified" });
  Object.assign(layout, { legend: above(style, { traceorder: "normal" }), margin: { l: 68, r: 12, t: 12, b: 40 },
    xaxis: { ...axis, title: { text: `time (${name})`, font: style } }, yaxis: { ...axis, title: { text: `energy ${answer.extent === "over the whole length" ? "over the whole length " : ""}(${scale.unit})`, font: style } } });
  const plot = el("div", { id: "energy-plot", role: "img", "aria-label": `Energy over time, up to ${show(largest, joule, 3)}` });
  by("energy").replaceChildren(plot, el("p", { class: "note" }, `Hatched: lost for good. Stores, losses and the work done agree within ${show(100 * answer.closure, "", 2)}\u202f% of the work.`));
  window.Plotly.newPlot(plot, traces, layout, SETTINGS);
}
