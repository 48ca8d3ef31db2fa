// Where the energy goes: stores and losses stacked, the work done on the outer shell as a line over them.
import { request } from "./api.js";
import { by, el } from "./dom.js";
import { SETTINGS, frame } from "./curves.js";
import { colour } from "./theme.js";
import { prefixed, show } from "./units.js";

// Okabe and Ito's colours and two lighter ones.
const COLOURS = ["#0072b2", "#56b4e9", "#009e73", "#8fd3b6", "#cc79a7", "#e69f00", "#f0e442", "#d55e00", "#7a5195", "#a0a0a0"];
let drawn = null;

export async function draw(run) {
  if (!run || drawn === run) return;
  const box = by("energy");
  drawn = run;
  if (!by("energy-plot")) box.replaceChildren(el("p", { class: "empty", role: "status" }, "Integrating the fluids’ energy…"));
  try {
    chart(await request(`/api/runs/${run}/energy?every=20`), box);
  } catch (failure) {
    drawn = null;
    box.replaceChildren(el("p", { class: "problem" }, failure.message));
  }
}

export function forget() { drawn = null; }

function chart(answer, box) {
  const time = answer.arrays.time.values;
  const parts = answer.entries.filter(({ role }) => role === "store" || role === "loss");
  const work = answer.entries.filter(({ role }) => role === "work");
  const largest = Math.max(...[...parts, ...work].flatMap(({ name }) => Array.from(answer.arrays[name].values, Math.abs)));
  const scale = prefixed("J/m", largest);
  const y = (name) => Float32Array.from(answer.arrays[name].values, (value) => value / scale.factor);
  const traces = parts.filter(({ name }) => answer.arrays[name].values.some((value) => Math.abs(value) > 1e-6 * largest)).map(({ name, label, role }, i) => ({
    x: time, y: y(name), name: label, stackgroup: "one", type: "scatter", mode: "lines", line: { width: 0.5, color: COLOURS[i % COLOURS.length] },
    fillpattern: role === "loss" ? { shape: "/", size: 6, solidity: 0.25 } : undefined, hovertemplate: `%{y:.3g} ${scale.unit}<extra>${label}</extra>`,
  }));
  for (const { name, label } of work) traces.push({ x: time, y: y(name), name: label, type: "scatter", mode: "lines", line: { color: colour("text"), width: 1.6 }, hovertemplate: `%{y:.3g} ${scale.unit}<extra>${label}</extra>` });
  const { style, axis, layout } = frame({ showlegend: true, height: 380, hovermode: "x unified" });
  Object.assign(layout, { legend: { orientation: "h", y: -0.18, font: { ...style, size: 11 } }, margin: { l: 68, r: 12, t: 12, b: 96 },
    xaxis: { ...axis, title: { text: "time (a/c)", font: style } }, yaxis: { ...axis, title: { text: `energy (${scale.unit})`, font: style } } });
  const plot = el("div", { id: "energy-plot", role: "img", "aria-label": `Energy over time, up to ${show(largest, "J/m", 3)}` });
  box.replaceChildren(plot, el("p", { class: "note" }, `Hatched: lost for good. Stores, losses and the work done agree within ${show(100 * answer.closure, "", 2)}\u202f% of the work.`));
  window.Plotly.newPlot(plot, traces, layout, SETTINGS);
}
