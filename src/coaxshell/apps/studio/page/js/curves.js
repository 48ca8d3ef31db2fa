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
const REST = 300; // ms without another picture after which plotly makes it anew
let drawn = null, resting = 0, clicked = () => {};

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

// Whether charts that stand beside each other have no room for that, as on a phone.
export const narrow = () => matchMedia("(max-width: 640px)").matches;

// A legend above a chart, which makes room for as many lines as it takes; below it would lie on the words of the axis where a chart is low.
export const above = (style, more = {}) => ({ orientation: "h", x: 0, y: 1.02, yanchor: "bottom", font: { ...style, size: 11 }, ...more });

// What all charts of the page share.
export function frame(more = {}) {
  const style = { color: colour("muted"), size: 12, family: "system-ui, sans-serif" };
  const axis = { gridcolor: colour("line"), zerolinecolor: colour("strong-line"), zerolinewidth: 1, linecolor: colour("line"), tickfont: style, ticks: "", automargin: false };
  const layout = { paper_bgcolor: "transparent", plot_bgcolor: "transparent", margin: { l: 68, r: 12, t: 20, b: 36 }, showlegend: false, hovermode: "x", font: style, annotations: [],
    hoverlabel: { bgcolor: colour("surface"), bordercolor: colour("line"), font: { color: colour("text"), size: 12 } }, ...more };
  return { style, axis, layout };
}

// Draw what is shown. While a slider moves only the lines of the current run do: they are drawn anew on the axes that there are, and all of
// the picture once the slider rests, which takes plotly a hundred milliseconds.
export function draw(...shown) {
  clearTimeout(resting);
  if (moved(...shown)) resting = setTimeout(() => whole(...shown), REST);
  else whole(...shown);
}

// Write the lines of the current run anew where nothing else differs from the picture and they fit on its axes; tell whether.
function moved(runs, quantity, which, unit = "transits", station = null) {
  const { current } = runs, { picture } = drawn ?? {}, box = by("curves");
  if (!picture || !current || current.full || picture.key !== keyOf(runs, quantity, which, unit, station)) return false;
  const lines = picture.lines.filter(({ run }) => run === "current"), histories = lines.map(({ panel }) => history(current, quantity.name, panel));
  const [low, high] = ends([...histories, ...picture.others]), room = picture.high - picture.low;
  if (histories.some((values, i) => values?.length !== lines[i].length) || low < picture.low || high > picture.high || high - low < 0.7 * room) return false;
  const nodes = new Map([...box.querySelectorAll(".scatterlayer .trace")].map((node) => [node.__data__?.[0]?.trace.index, node.querySelector(".js-line")]));
  if (lines.some(({ number }) => !nodes.get(number))) return false;
  lines.forEach(({ number, axes: [x, y] }, i) => {
    const values = scaled(histories[i], picture.factor), times = box.data[number].x, { [x]: across, [y]: up } = box._fullLayout;
    box.data[number].y = values;
    nodes.get(number).setAttribute("d", pathOf(times, values, across, up));
  });
  describe(runs, quantity, station, picture.unit);
  return true;
}

// The path of a line on plotly's linear axes, in hundredths of a pixel.
function pathOf(times, values, across, up) {
  const x = pixels(across), y = pixels(up), points = [];
  for (let i = 0; i < values.length; i++) points.push(`${x(times[i])},${y(values[i])}`);
  return `M${points.join("L")}`;
}

// From a value to its place along an axis, by both ends of its range: plotly's own l2p is rounded, too much so for the length of a unit.
function pixels({ range: [from, to], l2p }) {
  const first = l2p(from), each = (l2p(to) - first) / (to - from);
  return (value) => Math.round(100 * (first + each * (value - from))) / 100;
}

// What a picture shows besides the values of the current run.
let others = { bare: null, pinned: null, number: 0 };
function keyOf({ bare = null, pinned = null, current }, quantity, which, unit, station) {
  if (bare !== others.bare || pinned !== others.pinned) others = { bare, pinned, number: others.number + 1 };
  const { length, [length - 1]: last } = current.arrays.time.values;
  return [others.number, quantity.name, which, unit, station, length, last, UNITS[unit].of(current), document.documentElement.dataset.theme].join("|");
}

function whole(runs, quantity, which, unit = "transits", station = null) {
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
  const traces = [], lines = [];
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
      lines.push({ run: key, panel, length: values.length, number: traces.length, axes: [`xaxis${n}`, `yaxis${n}`] });
      traces.push({ type: "scatter", mode: "lines", name: RUNS[key].name, x: times[key], y: scaled(values, scale.factor), xaxis: `x${n}`, yaxis: `y${n}`,
        line: { color: colour(RUNS[key].colour), width: RUNS[key].width, dash: RUNS[key].dash, simplify: false }, hovertemplate: `%{y:.4~g} ${scale.unit}` });
    }
  });
  layout.annotations.push({ text: `${quantity.label} (${scale.unit})`, xref: "paper", yref: "paper", x: 0, xshift: -66, y: 0.5, textangle: -90, xanchor: "left", yanchor: "middle", showarrow: false, font: style });
  const box = by("curves");
  window.Plotly.react(box, traces, layout, SETTINGS);
  if (!drawn) box.on("plotly_click", ({ points }) => clicked(points[0].x / drawn.transit));
  const still = lines.filter(({ run }) => run !== "current").map(({ run, panel }) => history(runs[run], quantity.name, panel));
  const picture = runs.current && { key: keyOf(runs, quantity, which, unit, station), lines, others: still, low: low - margin, high: high + margin, factor: scale.factor, unit: unitOf };
  drawn = { wanted, transit: of(current), picture };
  describe(runs, quantity, station, unitOf);
}

function describe(runs, quantity, station, unit) {
  const run = runs.current ?? runs.bare, peak = (panel) => `${panel.title} up to ${show(largest(history(run, quantity.name, panel)), unit)}`;
  by("curves").setAttribute("role", "group");
  by("curves").setAttribute("aria-label", `${quantity.label} against time${station === null ? "" : ` at ${placeText(station)}`}: ${drawn.wanted.map(peak).join("; ")}`);
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
