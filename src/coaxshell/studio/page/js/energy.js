// Where the energy goes: stores and losses stacked, the work done on the outer shell as a line over them.
import { request } from "./api.js";
import { by, el } from "./dom.js";
import { SETTINGS, frame } from "./curves.js";
import { colour } from "./theme.js";
import { prefixed, show } from "./units.js";

// Okabe and Ito's colours and two lighter ones.
const COLOURS = ["#0072b2", "#56b4e9", "#009e73", "#8fd3b6", "#cc79a7", "#e69f00", "#f0e442", "#d55e00", "#7a5195", "#a0a0a0"];
let drawn = null;

export async function draw(run, every) {
  if (!run || drawn === run) return;
  const box = by("energy");
  drawn = run;
  if (!by("energy-plot")) box.replaceChildren(el("p", { class: "empty", role: "status" }, "Integrating the fluids’ energy…"));
  try {
    chart(await request(`/api/runs/${run}/energy?every=${every}`), box);
  } catch (failure) {
    drawn = null;
    box.replaceChildren(el("p", { class: "problem" }, failure.message));
  }
}

export function forget() { drawn = null; }

// The entries of one group as one area; a group is lost for good when all of it is.
function groups(answer) {
  const found = new Map();
  for (const { name, label, role, group } of answer.entries) {
    if (role !== "store" && role !== "loss") continue;
    const key = group || label, one = found.get(key) ?? { label: key.replaceAll("_", " "), lost: true, values: new Float64Array(answer.arrays[name].values.length) };
    one.lost &&= role === "loss";
    answer.arrays[name].values.forEach((value, i) => { one.values[i] += value; });
    found.set(key, one);
  }
  return [...found.values()];
}

function chart(answer, box) {
  const time = answer.arrays.time.values, parts = groups(answer);
  const work = answer.entries.filter(({ name }) => name === "exterior_work");
  const largest = Math.max(...[...parts.map(({ values }) => values), ...work.map(({ name }) => answer.arrays[name].values)].flatMap((values) => Array.from(values, Math.abs)));
  const scale = prefixed("J/m", largest);
  const y = (values) => Float32Array.from(values, (value) => value / scale.factor);
  const traces = parts.filter(({ values }) => values.some((value) => Math.abs(value) > 1e-6 * largest)).map(({ values, label, lost }, i) => ({
    x: time, y: y(values), name: label, stackgroup: "one", type: "scatter", mode: "lines", line: { width: 0.5, color: COLOURS[i % COLOURS.length] },
    fillpattern: lost ? { shape: "/", size: 6, solidity: 0.25 } : undefined, hovertemplate: `%{y:.3g} ${scale.unit}<extra>${label}</extra>`,
  }));
  for (const { name } of work) traces.push({ x: time, y: y(answer.arrays[name].values), name: "work of the pressure outside", type: "scatter", mode: "lines", line: { color: colour("text"), width: 1.6 }, hovertemplate: `%{y:.3g} ${scale.unit}<extra></extra>` });
  const { style, axis, layout } = frame({ showlegend: true, height: 380, hovermode: "x unified" });
  Object.assign(layout, { legend: { orientation: "h", y: -0.2, traceorder: "normal", font: { ...style, size: 11 } }, margin: { l: 68, r: 12, t: 12, b: 40 },
    xaxis: { ...axis, title: { text: "time (a/c)", font: style } }, yaxis: { ...axis, title: { text: `energy (${scale.unit})`, font: style } } });
  const plot = el("div", { id: "energy-plot", role: "img", "aria-label": `Energy over time, up to ${show(largest, "J/m", 3)}` });
  box.replaceChildren(plot, el("p", { class: "note" }, `Hatched: lost for good. Stores, losses and the work done agree within ${show(100 * answer.closure, "", 2)}\u202f% of the work.`));
  window.Plotly.newPlot(plot, traces, layout, SETTINGS);
}
