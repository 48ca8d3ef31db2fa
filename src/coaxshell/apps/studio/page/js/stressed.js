// Where a wall is stressed most: the largest stress over time at every angle and depth, the layers told apart, the peak marked.
import { row } from "./arrays.js";
import { SETTINGS, frame } from "./curves.js";
import { by, el } from "./dom.js";
import { Panel, offer } from "./panel.js";
import { colour } from "./theme.js";
import { prefixed, show } from "./units.js";
import { capital, shellPhrase } from "./words.js";

const COMPONENTS = [["von_mises", "von Mises stress"], ["hoop", "Hoop stress"], ["axial", "Axial stress"]];
let panel, shell = null, component = "von_mises", run = null;

export function setUp() {
  const shellSelect = el("select", { "aria-label": "Shell", id: "stressed-shell", onchange: () => { shell = Number(shellSelect.value); draw(run); } });
  const kind = el("select", { "aria-label": "Stress", id: "stressed-component", onchange: () => { component = kind.value; draw(run); } }, ...COMPONENTS.map(([value, text]) => el("option", { value }, text)));
  panel = new Panel(by("stressed"), shellSelect, kind);
  panel.select = shellSelect;
}

export const forget = () => panel.forget();

export function draw(now) {
  run = now;
  const elastic = run.shells.filter((one) => !one.rigid);
  if (!elastic.length) return panel.instead("No shell of this system is elastic, so none is stressed.");
  shell = Number(offer(panel.select, elastic.map((one) => [one.index, capital(shellPhrase(one.index, run.shells.length))]), shell ?? elastic[0].index));
  return panel.ask({ kind: "stressed", run: run.run, shell, component }, "Looking through the wall", chart);
}

function chart({ arrays, layers, peak, component: of }) {
  const plot = by("stressed-plot") ?? el("div", { id: "stressed-plot", class: "study-plot" }), words = COMPONENTS.find(([name]) => name === of)[1].replace(/^H/, "h").replace(/^A/, "a");
  const depths = [], rows = [], lines = [];
  layers.forEach((_, i) => {
    const depth = arrays[`depth/${i}`].values, values = arrays[`stress/${i}`];
    for (let k = 0; k < depth.length; k++) { depths.push(1e3 * depth[k] + (k === 0 && i ? 1e-6 : 0)); rows.push(row(values, k)); }
    lines.push(1e3 * depth.at(-1));
  });
  const scale = prefixed("Pa", peak.value), { style, axis, layout } = frame({ height: 340, hovermode: "closest" }), angle = arrays.angle.values, half = angle[0] === 0;
  const edge = { color: colour("surface"), width: 1 };
  Object.assign(layout, { margin: { l: 62, r: 12, t: 12, b: 48 },
    xaxis: { ...axis, title: { text: "angle from the source’s direction (°)", font: style, standoff: 6 }, range: half ? [0, 180] : [-180, 180], dtick: half ? 30 : 60, zeroline: false },
    yaxis: { ...axis, title: { text: "depth, outward (mm)", font: style }, range: [depths[0], depths.at(-1)], zeroline: false },
    shapes: lines.slice(0, -1).map((y) => ({ type: "line", xref: "paper", x0: 0, x1: 1, y0: y, y1: y, line: edge })),
    annotations: layers.map(({ material }, i) => ({ text: material, xref: "paper", x: 0.99, xanchor: "right", y: ((i ? lines[i - 1] : depths[0]) + lines[i]) / 2, showarrow: false, font: { ...style, color: "#fff", size: 11 }, bgcolor: "rgba(0, 0, 0, 0.45)", borderpad: 2 })) });
  const trace = { type: "heatmap", x: angle, y: depths, z: rows.map((one) => Float32Array.from(one, (value) => value / scale.factor)), zmin: 0, zmax: peak.value / scale.factor, zsmooth: "best", colorscale: "Cividis",
    colorbar: { title: { text: `largest ${words} (${scale.unit})`, side: "right", font: style }, tickfont: style, thickness: 14, outlinewidth: 0 }, hovertemplate: `%{x}°, %{y:.3g} mm: %{z:.3g} ${scale.unit}<extra></extra>` };
  const at = half ? Math.abs(((peak.angle + 540) % 360) - 180) : ((peak.angle + 540) % 360) - 180;
  const star = { type: "scatter", mode: "markers", x: [at], y: [1e3 * peak.depth], cliponaxis: false, marker: { symbol: "star", size: 14, color: "#fff", line: { color: "#000", width: 1.2 } }, hoverinfo: "skip" };
  const where = `in its layer of ${peak.material}, ${show(Math.abs(peak.depth), "m", 3)} ${peak.depth < 0 ? "inside" : "outside"} the middle, at ${show(peak.angle, "deg", 4)}${peak.station === null ? "" : `, z = ${show(peak.station, "m")}`}, t = ${show(peak.time, "", 4)} a/c`;
  const text = `Largest ${words} anywhere: ${show(peak.value, "Pa")} ${where}.${peak.margin === null ? " No strength of its materials is known." : ` The weakest layer stands ${show(peak.margin, "", 3)} times its largest stress.`}`;
  panel.body.replaceChildren(plot, el("p", { class: "note", id: "stressed-peak" }, text));
  if (!window.Plotly) return;
  window.Plotly.react(plot, [trace, star], layout, SETTINGS);
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", `Largest stress over time by angle and depth. ${text}`);
}

export const redraw = () => run && draw(run);
