// Spectra of a run at head and tail of a shell: what equipment on it feels (shock response), and the Fourier transform of a history.
import { row } from "./arrays.js";
import { SETTINGS, above, frame, narrow } from "./curves.js";
import { by, el } from "./dom.js";
import { Panel, offer } from "./panel.js";
import { placeText } from "./space.js";
import { colour } from "./theme.js";
import { pretty, show } from "./units.js";
import { capital, shellPhrase } from "./words.js";

const QUANTITIES = [["stress", "Fourier: hoop stress"], ["shell_acceleration", "Fourier: acceleration"], ["shell_velocity", "Fourier: velocity"], ["displacement", "Fourier: displacement"]];
let panel, shell = null, quantity = "stress", run = null, station = null;

export function setUp() {
  const shellSelect = el("select", { "aria-label": "Shell", id: "spectra-shell", onchange: () => { shell = Number(shellSelect.value); draw(run, station); } });
  const what = el("select", { "aria-label": "Fourier transform of", id: "spectra-quantity", onchange: () => { quantity = what.value; draw(run, station); } }, ...QUANTITIES.map(([value, text]) => el("option", { value }, text)));
  panel = new Panel(by("spectra"), shellSelect, what);
  panel.select = shellSelect;
}

export const forget = () => panel.forget();

export function draw(now, at) {
  [run, station] = [now, at];
  const elastic = run.shells.filter((one) => !one.rigid);
  if (!elastic.length) return panel.instead("No shell of this system moves, so nothing has a spectrum.");
  shell = Number(offer(panel.select, elastic.map((one) => [one.index, capital(shellPhrase(one.index, run.shells.length))]), shell ?? elastic.at(-1).index));
  const number = run.stations ? { station: Math.max(0, run.stations.indexOf(station)) } : {};
  return panel.ask({ kind: "spectra", run: run.run, shell, quantity, ...number }, "Reading the spectra", chart);
}

function chart({ arrays, label, station: z, warnings }) {
  const plot = by("spectra-plot") ?? el("div", { id: "spectra-plot", class: "study-plot tall" }), hertz = arrays.frequency.values, { style, axis, layout } = frame({ showlegend: true, hovermode: "x", height: narrow() ? 620 : 380 });
  const log = { ...axis, type: "log", zeroline: false, exponentformat: "power", dtick: 1 }, stretch = [Math.log10(hertz[0]), Math.log10(hertz.at(-1))];
  const stacked = narrow(), [left, right, upper, lower] = stacked ? [[0, 1], [0, 1], [0.6, 1], [0, 0.4]] : [[0, 0.46], [0.56, 1], [0, 1], [0, 1]];
  const traces = ["shock", "fourier"].flatMap((name, column) => [0, 1].map((end) => ({ type: "scatter", mode: "lines", name: end ? "tail" : "head", legendgroup: end, showlegend: !column, x: hertz, y: row(arrays[name], end),
    xaxis: column ? "x2" : "x", yaxis: column ? "y2" : "y", line: { color: colour(end ? "pinned" : "current"), width: 1.6, dash: end ? "4px,2px" : "solid", simplify: false }, hovertemplate: "%{y:.3g}" })));
  const unit = (name) => pretty(arrays[name].unit);
  Object.assign(layout, { margin: { l: 68, r: 12, t: 26, b: 44 }, legend: above(style, { y: 1.08 }),
    xaxis: { ...log, domain: left, range: stretch, anchor: "y", title: { text: "natural frequency (Hz)", font: style, standoff: 4 } }, yaxis: { ...log, domain: upper, dtick: "D2", anchor: "x", title: { text: `pseudo-velocity (${unit("shock")})`, font: style, standoff: 4 } },
    xaxis2: { ...log, domain: right, range: stretch, anchor: "y2", title: { text: "frequency (Hz)", font: style, standoff: 4 } }, yaxis2: { ...log, domain: lower, dtick: "D2", anchor: "x2", title: { text: `${label.replace(/ of .*/, "")} (${unit("fourier")})`, font: style, standoff: 4 } },
    annotations: [["Shock response, Q = 10", left, upper], ["Fourier transform", right, lower]].map(([text, [x], [, y]]) => ({ text, xref: "paper", yref: "paper", x, y, xanchor: "left", yanchor: "bottom", showarrow: false, font: { ...style, color: colour("text") } })) });
  const most = [0, 1].map((end) => Math.max(...row(arrays.shock, end))), text = `Equipment on the shell feels a pseudo-velocity of up to ${show(most[0], "m/s", 3)} at the head and ${show(most[1], "m/s", 3)} at the tail${z === null ? "" : `, ${placeText(z)}`} (a damping of 5\u202f%).`;
  panel.body.replaceChildren(...(warnings.length ? [el("ul", { class: "warnings", "aria-label": "Warnings" }, ...warnings.map((one) => el("li", {}, `${capital(one)}.`)))] : []), plot, el("p", { class: "note", id: "spectra-said" }, text));
  if (!window.Plotly) return;
  window.Plotly.react(plot, traces, layout, SETTINGS);
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", `Shock response spectrum and Fourier transform of the ${label}. ${text}`);
}

export const redraw = () => run && draw(run, station);
