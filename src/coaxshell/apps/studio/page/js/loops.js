// The control panel: how much the loop of each shell stands, as a traffic light; voltage against its limit; Bode and Nyquist of the loop that stands least.
import { SETTINGS, above, frame, narrow } from "./curves.js";
import { by, el } from "./dom.js";
import { Panel } from "./panel.js";
import { colour } from "./theme.js";
import { show } from "./units.js";
import { capital, shellName, shellPhrase } from "./words.js";

// What textbooks ask of a loop at least (Åström and Murray, Feedback Systems, section 10.3): a gain margin of 2 and a phase margin of 30 degrees.
// Half of that way from the margin at which a loop grows is little, less is too little.
const LEAST = { gain: 2, phase: 30 }, FAR = 2.5, HUES = 7;
const LIGHTS = { good: ["●", "enough"], fair: ["▲", "little"], poor: ["■", "too little"] };
let panel, run = null;

export function setUp() { panel = new Panel(by("control")); }
export const forget = () => panel.forget();

export function draw(now) {
  run = now;
  if (!run.system.control) return panel.instead("Nothing is fed back in this system: choose a kind of control in the form, with layers that sense and drive.");
  return panel.ask({ kind: "loops", run: run.run }, "Following the loops", chart);
}

export function lightOf({ gain_margin: gain, lesser_gain_margin: less, phase_margin: phase }) {
  const factors = [gain?.value, less && 1 / less.value].filter(Boolean), factor = Math.min(...factors, Infinity), turn = phase?.value ?? Infinity;
  if (factor >= LEAST.gain && turn >= LEAST.phase) return "good";
  return factor >= 1 + (LEAST.gain - 1) / 2 && turn >= LEAST.phase / 2 ? "fair" : "poor";
}

function chart({ shells, arrays }) {
  const along = shells.some(({ wavenumber }) => wavenumber !== undefined), columns = ["", "Value", "Order", "At", ...(along ? ["k (1/m)"] : []), ""];
  const rows = shells.map((one) => [...voltages(one.name, along), ...margins(one, along)]), least = along ? "all orders and six wavenumbers k along the axis" : "all orders";
  const table = el("table", { class: "peaks loops" }, el("caption", {}, `What the loop of each shell stands, the others closed: the least over ${least}. Enough is a gain margin of 2 and a phase margin of 30°.`),
    el("thead", {}, el("tr", {}, ...columns.map((text) => (text ? el("th", { scope: "col", class: "number" }, text) : el("td", {}))))),
    ...shells.map((one, i) => el("tbody", {}, el("tr", {}, el("th", { scope: "rowgroup", colspan: columns.length - 1 }, `${capital(phrase(one.name))}: `, lamp(lightOf(one)))), ...rows[i])));
  const plot = by("loops-plot") ?? el("div", { id: "loops-plot", class: "study-plot tall" });
  panel.body.replaceChildren(el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "Margins of the control" }, table), plot);
  if (!window.Plotly) return;
  const { traces, layout } = bode(shells, arrays);
  window.Plotly.react(plot, traces, layout, SETTINGS);
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", `Bode and Nyquist plots of the loops that stand the least delay: ${shells.map((one) => `${phrase(one.name)}, ${which(one)}`).join("; ")}`);
}

const which = ({ order, wavenumber }) => `order ${order}${wavenumber === undefined ? "" : `, k = ${show(wavenumber, "", 3)}/m`}`;
const phrase = (name) => shellPhrase(run.shells.findIndex(({ index }) => shellName(index, run.shells.length) === name), run.shells.length);
const lamp = (light) => el("span", { class: `light ${light}` }, el("i", { "aria-hidden": "true" }, LIGHTS[light][0]), ` ${LIGHTS[light][1]}`);

function margins({ gain_margin, lesser_gain_margin, phase_margin, delay_margin }, along) {
  const line = (words, one, value, none) => el("tr", {}, el("th", { scope: "row" }, words), el("td", { class: "number" }, one ? value(one.value) : none), el("td", { class: "number" }, one ? String(one.order) : ""), el("td", { class: "number" }, one?.frequency ? show(one.frequency, "Hz", 3) : ""),
    ...(along ? [el("td", { class: "number" }, one ? show(one.wavenumber, "", 3) : "")] : []), el("td", {}));
  const times = (value) => `${show(value, "", 3)} times`;
  return [line("gain margin", gain_margin, times, "10 times or more"), ...(lesser_gain_margin ? [line("down to", lesser_gain_margin, times, "")] : []),
    line("phase margin", phase_margin, (value) => show(value, "deg", 3), "any"), line("further delay", delay_margin, (value) => show(value, "s", 3), "any")];
}

// The largest voltage that the law asks for against what the actuator stands.
function voltages(name, along) {
  const shell = run.shells.find(({ index }) => shellName(index, run.shells.length) === name), bar = run.bars.find((one) => one.name.startsWith("actuator_voltage") && one.shell === shell?.index);
  if (!bar || !shell.actuator_limit) return [];
  const share = bar.value / shell.actuator_limit, light = share <= 0.8 ? "good" : share <= 1 ? "fair" : "poor", words = { good: "within", fair: "close to it", poor: "beyond it" }[light];
  return [el("tr", {}, el("th", { scope: "row" }, "voltage asked for"), el("td", { class: "number" }, show(bar.value, "V")), el("td", { class: "number", colspan: along ? 3 : 2 }, `of ${show(shell.actuator_limit, "V")}`),
    el("td", {}, el("meter", { min: 0, max: 1, high: 0.8, optimum: 0, value: Math.min(share, 1), "aria-label": `Voltage of the ${phrase(name)} against its limit` }), el("span", { class: `light ${light}` }, ` ${Math.round(100 * share)}\u202f%, ${words}`)))];
}

function bode(shells, arrays) {
  const { style, axis, layout } = frame({ showlegend: true, height: narrow() ? 780 : 400, hovermode: "closest" }), traces = [];
  shells.forEach((one, i) => {
    const hertz = arrays[`frequency/${i}`].values, re = arrays[`real/${i}`].values, im = arrays[`imaginary/${i}`].values, line = { color: colour(`series-${i % HUES}`), width: 1.6, dash: i % 2 ? "dash" : "solid", simplify: false };
    const shared = { type: "scatter", mode: "lines", name: `${one.name}, ${which(one)}`, legendgroup: i, line, showlegend: false };
    traces.push({ ...shared, showlegend: true, x: hertz, y: Float32Array.from(re, (value, k) => Math.hypot(value, im[k])), hovertemplate: "%{x:.4~s}Hz: %{y:.3g}" },
      { ...shared, mode: "markers", marker: { size: 2.5, color: line.color }, x: hertz, y: Float32Array.from(re, (value, k) => (Math.atan2(im[k], value) * 180) / Math.PI), xaxis: "x2", yaxis: "y2", hovertemplate: "%{x:.4~s}Hz: %{y:.0f}°" },
      { ...shared, x: re, y: im, xaxis: "x3", yaxis: "y3", hovertemplate: "%{x:.3g} + %{y:.3g} i" });
  });
  traces.push({ type: "scatter", mode: "markers", x: [1], y: [0], xaxis: "x3", yaxis: "y3", name: "where it would grow", showlegend: true, marker: { symbol: "cross-thin", size: 12, line: { width: 2, color: colour("bad") } }, hoverinfo: "skip" });
  const log = { ...axis, type: "log", exponentformat: "power", dtick: 1, zeroline: false };
  const [left, right, gain, phase, plane] = narrow() ? [[0, 1], [0, 1], [0.77, 1], [0.52, 0.73], [0, 0.4]] : [[0, 0.52], [0.64, 1], [0.55, 1], [0, 0.45], [0, 1]];
  Object.assign(layout, { margin: { l: 60, r: 12, t: 12, b: 44 }, legend: above(style),
    xaxis: { ...log, domain: left, showticklabels: false }, yaxis: { ...log, domain: gain, title: { text: "|L|", font: style }, anchor: "x" },
    xaxis2: { ...log, domain: left, tickangle: 0, matches: "x", anchor: "y2", title: { text: "frequency (Hz)", font: style, standoff: 4 } }, yaxis2: { ...axis, domain: phase, range: [-180, 180], dtick: 90, title: { text: "phase of L (°)", font: style } },
    xaxis3: { ...axis, domain: right, range: [-FAR, FAR], anchor: "y3", title: { text: "Re L", font: style, standoff: 4 } }, yaxis3: { ...axis, domain: plane, range: [-FAR, FAR], anchor: "x3", scaleanchor: "x3", title: { text: "Im L", font: style, standoff: 4 } },
    shapes: [{ type: "circle", xref: "x3", yref: "y3", x0: -1, x1: 1, y0: -1, y1: 1, line: { color: colour("strong-line"), width: 1 } }] });
  return { traces, layout };
}

export const redraw = () => run && draw(run);
