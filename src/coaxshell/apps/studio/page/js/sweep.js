// Sweeps: a small form, and their results drawn.
import { SETTINGS, frame } from "./curves.js";
import { by, el } from "./dom.js";
import { choose, firstMetric, labelled, metricOptions, pathOptions, spacing, spelt, suggested, typed } from "./study_fields.js";
import { colour } from "./theme.js";
import { numeral, prefixed, pretty } from "./units.js";
import { told } from "./words.js";

export const title = "Sweep", start = "Start sweep";
let described;

export function setUp(form, current) {
  described = current;
  form.addEventListener("change", ({ target }) => { if (/^path2?$/.test(target.name)) suggest(target.name.slice(4)); });
}

// The form offers every number of the system, by the path it is known by.
export function offer(form) {
  const { metrics } = described(), kept = Object.fromEntries(new FormData(form));
  const axis = (which, values) => [labelled("From", typed(`from${which}`, kept[`from${which}`] ?? "")), labelled("To", typed(`to${which}`, kept[`to${which}`] ?? "")),
    labelled("Values", typed(`count${which}`, kept[`count${which}`] ?? values, { inputmode: "numeric", size: 5 })), labelled("Spacing", choose(`scale${which}`, spacing(kept[`scale${which}`])))];
  form.replaceChildren(
    el("fieldset", {}, el("legend", {}, "Vary"), labelled("What", choose("path", pathOptions(kept.path))), ...axis("", 11)),
    el("fieldset", {}, el("legend", {}, "Against (optional)"), labelled("What", choose("path2", [el("option", { value: "" }, "nothing else"), ...pathOptions(kept.path2)])), ...axis("2", 5)),
    el("fieldset", {}, el("legend", {}, "Watch"), labelled("Metric", choose("metric", metricOptions(metrics, kept.metric ?? firstMetric(metrics))))),
    el("div", { class: "buttons" }, el("button", { class: "main" }, start)), el("p", { class: "problem", id: "sweep-problem", role: "alert", hidden: true }));
  if (!kept.path) suggest("");
}

function suggest(which) {
  const entries = by("sweep").elements, path = entries[`path${which}`].value;
  if (!path) return;
  for (const [name, value] of Object.entries(suggested(described().system, path))) entries[`${name}${which}`].value = value;
}

function axis(data, which) {
  const entry = { from: numeral(data.get(`from${which}`)), to: numeral(data.get(`to${which}`)), count: numeral(data.get(`count${which}`)) };
  if (data.get(`scale${which}`) === "log") entry.scale = "log";
  return entry;
}

export function body(form) {
  const data = new FormData(form), over = { [data.get("path")]: axis(data, "") };
  if (data.get("path2")) over[data.get("path2")] = axis(data, "2");
  return { kind: "sweep", over, metrics: [data.get("metric")], points: "grid" };
}

export const named = ({ over, metrics: [metric] }) => `${spelt(metric)} over ${Object.keys(over).map(spelt).join(" and ")}`;

// What is wrong, beside its field where it has one.
export function mark(form, problem) {
  const box = by("sweep-problem");
  for (const input of form.querySelectorAll("[aria-invalid]")) { input.removeAttribute("aria-invalid"); input.removeAttribute("aria-describedby"); }
  box.hidden = !problem;
  if (!problem) return;
  box.textContent = told(problem);
  const entries = form.elements, which = entries.path2.value && problem.where.startsWith(`over.${entries.path2.value}`) ? "2" : problem.where.startsWith("over.") ? "" : null;
  const part = problem.where.match(/\.(from|to|count|scale)$/)?.[1] ?? "from";
  const spot = which === null ? problem.where.startsWith("metrics") && entries.metric : entries[`${part}${which}`];
  if (spot) { spot.setAttribute("aria-invalid", "true"); spot.setAttribute("aria-describedby", box.id); }
}

export function show(result, box) {
  const plot = el("div", { id: "study-plot", class: "study-plot" });
  box.replaceChildren(plot, ...result.failures.slice(0, 1).map(() => el("p", { class: "note" }, `${result.failures.length} of the cases could not be solved: ${result.failures[0].reason}`)));
  draw(plot, result);
  return () => draw(plot, result);
}

// Whether positive values grow by equal factors and not by equal steps, as those of a logarithmic sweep do.
function geometric(values) {
  if (values.length < 3 || values.some((value) => !(value > 0))) return false;
  const uneven = (parts) => Math.max(...parts) - Math.min(...parts);
  const logs = values.slice(1).map((value, i) => Math.log(value / values[i])), steps = values.slice(1).map((value, i) => (value - values[i]) / (values.at(-1) - values[0]));
  return uneven(logs) < 0.02 * Math.max(...logs.map(Math.abs)) && uneven(steps) > 0.02;
}

function draw(plot, { coordinates, metrics: [metric] }) {
  const [first, second] = coordinates;
  const largest = Math.max(...metric.values.flat().map((value) => Math.abs(value ?? 0)));
  const scale = prefixed(metric.unit, largest), logarithmic = (axis) => (geometric(axis.values) ? "log" : "linear");
  const name = (axis) => `${axis.label ?? axis.name}${axis.unit && axis.unit !== "1" ? ` (${pretty(axis.unit)})` : ""}`;
  const divided = (values) => values.map((value) => (Array.isArray(value) ? divided(value) : value === null ? null : value / scale.factor));
  const label = `${metric.label ?? metric.name} (${scale.unit || "–"})`;
  const { style, axis, layout } = frame({ height: 360, hovermode: "closest" });
  const trace = second
    ? { type: "heatmap", x: first.values, y: second.values, z: divided(metric.values[0].map((_, j) => metric.values.map((line) => line[j]))), colorscale: "Viridis", colorbar: { title: { text: label, side: "right" } } }
    : { type: "scatter", mode: "lines+markers", x: first.values, y: divided(metric.values), line: { color: colour("current"), width: 1.6 }, marker: { size: 5 } };
  Object.assign(layout, { xaxis: { ...axis, type: logarithmic(first), title: { text: name(first), font: style } }, yaxis: { ...axis, type: second ? logarithmic(second) : "linear", title: { text: second ? name(second) : label.replace(", ", "<br>"), font: style } }, margin: { l: 84, r: 20, t: 12, b: 52 } });
  window.Plotly.react(plot, [trace], layout, SETTINGS);
}
