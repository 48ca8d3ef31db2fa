// Histories at head and tail of the shells: the current system, the bare one, a pinned one.
import { el, by, svg } from "./dom.js";
import { row } from "./arrays.js";
import { placeText } from "./space.js";
import { colour } from "./theme.js";
import { prefixed, show } from "./units.js";
import { shellName } from "./words.js";

export const SETTINGS = { displayModeBar: false, responsive: true, doubleClick: "reset", scrollZoom: false };
export const RUNS = {
  current: { name: "current", colour: "current", dash: "solid", width: 2 },
  bare: { name: "bare", colour: "bare", dash: "4px,2px", width: 1.4 },
  pinned: { name: "pinned", colour: "pinned", dash: "solid", width: 1.4 },
};
// What time is read in: the label of the axis, and one transit in it.
export const UNITS = {
  transits: { name: "a/c", of: () => 1 },
  ms: { name: "ms", of: (run) => 1e3 * run.transit_time_seconds },
};
const ORDER = ["bare", "pinned", "current"]; // drawn one over the other
let drawn = null, clicked = () => {};

export const onTime = (watcher) => { clicked = watcher; };

export function legend(runs) {
  by("legend").replaceChildren(...["current", "bare", "pinned"].filter((key) => runs[key]).map((key) => {
    const { name, colour: tint, dash, width } = RUNS[key];
    return el("li", {}, svg("svg", { width: 24, height: 8, "aria-hidden": "true" }, svg("line", { x1: 0, x2: 24, y1: 4, y2: 4, stroke: `var(--${tint})`, "stroke-width": width + 0.4, "stroke-dasharray": dash === "solid" ? null : "4 2" })), name);
  }));
}

// Panels: one for each shell shown and for head and tail, or the absorbers at head and tail.
function panels(result, quantity, which) {
  if (quantity === "absorber_force") return [0].flatMap((shell) => [0, 1].map((end) => ({ shell, end, column: end, row: 0, title: `absorber nearest to the ${end ? "tail" : "head"}` })));
  return which.flatMap((shell, column) => [0, 1].map((end) => ({ shell, end, column, row: end, title: `${shellName(shell, result.shells.length)}, ${end ? "tail" : "head"}` })));
}

// What all charts of the page share.
export function frame(more = {}) {
  const style = { color: colour("muted"), size: 12, family: "system-ui, sans-serif" };
  const axis = { gridcolor: colour("line"), zerolinecolor: colour("strong-line"), zerolinewidth: 1, linecolor: colour("line"), tickfont: style, ticks: "", automargin: false };
  const layout = { paper_bgcolor: "transparent", plot_bgcolor: "transparent", margin: { l: 68, r: 12, t: 20, b: 36 }, showlegend: false, hovermode: "x", font: style, annotations: [],
    hoverlabel: { bgcolor: colour("surface"), bordercolor: colour("line"), font: { color: colour("text"), size: 12 } }, ...more };
  return { style, axis, layout };
}

export function draw(runs, quantity, which, unit = "transits", station = null) {
  const current = runs.current ?? runs.bare;
  if (!current || !window.Plotly) return;
  const wanted = panels(current, quantity.name, which).map((panel) => ({ ...panel, station }));
  const unitOf = current.arrays[`${quantity.name}/${wanted[0].shell}`]?.unit ?? quantity.unit; // of absorbers at points another than of lines
  const columns = Math.max(...wanted.map((p) => p.column)) + 1, rows = Math.max(...wanted.map((p) => p.row)) + 1;
  const [low, high] = ends(wanted.flatMap((p) => ORDER.map((key) => history(runs[key], quantity.name, p))));
  const scale = prefixed(unitOf, Math.max(-low, high)), margin = 0.06 * (high - low) || 1;
  const { style, axis, layout } = frame(), { name, of } = UNITS[unit];
  const times = Object.fromEntries(ORDER.filter((key) => runs[key]).map((key) => [key, scaled(runs[key].arrays.time.values, 1 / of(runs[key]))]));
  layout.uirevision = `${quantity.name}${which}${unit}${station}`;
  const traces = [];
  wanted.forEach((panel, i) => {
    const n = i ? String(i + 1) : "", gapX = 0.05, gapY = 0.15;
    const width = (1 - gapX * (columns - 1)) / columns, height = (1 - gapY * (rows - 1)) / rows;
    const left = panel.column * (width + gapX), bottom = 1 - panel.row * (height + gapY) - height;
    const span = current.arrays.time.values.at(-1) * of(current);
    layout[`xaxis${n}`] = { ...axis, domain: [left, left + width], anchor: `y${n}`, range: [0, span], showticklabels: panel.row === rows - 1, zeroline: false, ...(i ? { matches: "x" } : {}), nticks: 6, ...(panel.row === rows - 1 ? { title: { text: `time (${name})`, font: style, standoff: 4 } } : {}) };
    layout[`yaxis${n}`] = { ...axis, domain: [bottom, bottom + height], anchor: `x${n}`, nticks: 5, showticklabels: panel.column === 0, range: [(low - margin) / scale.factor, (high + margin) / scale.factor], ...(i ? { matches: "y" } : {}) };
    layout.annotations.push({ text: panel.title, xref: "paper", yref: "paper", x: left, y: bottom + height, xanchor: "left", yanchor: "bottom", showarrow: false, font: { ...style, color: colour("text") } });
    for (const key of ORDER) {
      const values = history(runs[key], quantity.name, panel);
      if (!values) continue;
      traces.push({ type: "scatter", mode: "lines", name: RUNS[key].name, x: times[key], y: scaled(values, scale.factor), xaxis: `x${n}`, yaxis: `y${n}`,
        line: { color: colour(RUNS[key].colour), width: RUNS[key].width, dash: RUNS[key].dash, simplify: false }, hovertemplate: `%{y:.4~g} ${scale.unit}` });
    }
  });
  layout.annotations.push({ text: `${quantity.label} (${scale.unit})`, xref: "paper", yref: "paper", x: 0, xshift: -66, y: 0.5, textangle: -90, xanchor: "left", yanchor: "middle", showarrow: false, font: style });
  const box = by("curves");
  window.Plotly.react(box, traces, layout, SETTINGS);
  if (!drawn) box.on("plotly_click", ({ points }) => clicked(points[0].x / drawn.transit));
  drawn = { wanted, key: quantity.name, transit: of(current) };
  box.setAttribute("role", "group");
  box.setAttribute("aria-label", `${quantity.label} against time${station === null ? "" : ` at ${placeText(station)}`}: ${wanted.map((p) => `${p.title} up to ${show(largest(history(current, quantity.name, p)), unitOf)}`).join("; ")}`);
}

function history(run, name, { shell, end, station }) {
  const array = run?.arrays[`${name}/${shell}`];
  if (!array) return null;
  if (array.shape.length < 3) return row(array, Math.min(end, array.shape[0] - 1));
  const number = run.stations.indexOf(station);
  return number < 0 ? null : row(array, number * array.shape[1] + end);
}

function largest(values) {
  let most = 0;
  for (const value of values ?? []) most = Math.max(most, Math.abs(value));
  return most;
}

function ends(histories) {
  let low = 0, high = 0;
  for (const values of histories) for (const value of values ?? []) { if (value < low) low = value; else if (value > high) high = value; }
  return [low, high];
}

function scaled(values, factor) {
  const out = new Float32Array(values.length);
  for (let i = 0; i < values.length; i++) out[i] = values[i] / factor;
  return out;
}

// The instant of the wave as a line in every panel; plain elements, since plotly would take tens of milliseconds a frame.
export function cursor(time) {
  const box = by("curves"), full = box._fullLayout;
  for (const old of box.querySelectorAll(".time-cursor")) if (time === null || !drawn) old.remove();
  if (time === null || !full || !drawn) return;
  drawn.wanted.forEach((_, i) => {
    const n = i ? String(i + 1) : "", x = full[`xaxis${n}`], y = full[`yaxis${n}`];
    if (!x || !y) return;
    const line = box.querySelectorAll(".time-cursor")[i] ?? box.appendChild(el("div", { class: "time-cursor" }));
    const at = x.l2p(time * drawn.transit);
    line.hidden = at < 0 || at > x._length;
    Object.assign(line.style, { left: `${x._offset + at}px`, top: `${y._offset}px`, height: `${y._length}px` });
  });
}
