// Sweeps from the page: a small form, jobs watched and cancelled, results drawn and taken home.
import { client, request } from "./api.js";
import { SETTINGS, frame } from "./curves.js";
import { by, el } from "./dom.js";
import { ended, watch } from "./events.js";
import { rangeOf } from "./ranges.js";
import { colour } from "./theme.js";
import { prefixed, pretty, show } from "./units.js";

let described; // () => { system, metrics }
const jobs = new Map();

export function setUp(current) {
  described = current;
  by("studies").replaceChildren(el("form", { id: "sweep", class: "study" }), el("div", { id: "study-jobs", "aria-live": "polite" }), el("div", { id: "study-result" }));
  by("sweep").addEventListener("submit", (event) => { event.preventDefault(); start(); });
}

// The form offers every number of the system that has a range, by the path it is known by.
export function offer() {
  const { system, metrics } = described();
  if (!system || by("sweep").contains(document.activeElement)) return;
  const kept = Object.fromEntries(new FormData(by("sweep")));
  const paths = varied();
  const options = (chosen) => paths.map(({ path, label }) => el("option", { value: path, selected: path === chosen }, label));
  const number = (name, label, fallback) => el("label", {}, el("span", {}, label), el("input", { type: "text", name, value: kept[name] ?? fallback, size: 8, inputmode: "decimal" }));
  const choose = (name, label, ...inner) => el("label", {}, el("span", {}, label), el("select", { name }, ...inner));
  by("sweep").replaceChildren(
    el("fieldset", {}, el("legend", {}, "Vary"), choose("path", "What", ...options(kept.path)), number("from", "From", "0"), number("to", "To", "50"), number("count", "Values", "11"),
      choose("scale", "Spacing", el("option", { value: "linear" }, "even"), el("option", { value: "log", selected: kept.scale === "log" }, "logarithmic"))),
    el("fieldset", {}, el("legend", {}, "Against (optional)"), choose("path2", "What", el("option", { value: "" }, "nothing else"), ...options(kept.path2)), number("from2", "From", "1e5"), number("to2", "To", "1e7"), number("count2", "Values", "5"),
      choose("scale2", "Spacing", el("option", { value: "linear" }, "even"), el("option", { value: "log", selected: kept.scale2 === "log" }, "logarithmic"))),
    el("fieldset", {}, el("legend", {}, "Watch"), choose("metric", "Metric", ...(metrics ?? []).map((name) => el("option", { value: name, selected: name === (kept.metric ?? "inner.peak_stress") }, name)))),
    el("button", { class: "main" }, "Start sweep"), el("p", { class: "problem", id: "sweep-problem", role: "alert", hidden: true }));
  by("sweep").elements.path.addEventListener("change", () => suggest(""));
  by("sweep").elements.path2.addEventListener("change", () => suggest("2"));
  if (!kept.path) suggest("");
}

function varied() {
  return [...by("form").querySelectorAll("input[data-unit]")].map((input) => ({ path: input.dataset.path, label: input.dataset.path.replaceAll("_", " ") }))
    .filter(({ path }) => !/\.(time|pressure)$/.test(path)).sort((a, b) => Boolean(rangeOf(b.path)) - Boolean(rangeOf(a.path)));
}

function suggest(which) {
  const fields = by("sweep").elements, path = fields[`path${which}`].value, range = rangeOf(path);
  if (!range) return;
  const signed = range.kind === "signed";
  fields[`from${which}`].value = signed ? -range.high / 10 : range.kind === "log" ? range.low : Math.max(range.low, path.endsWith("count") ? 0 : range.low);
  fields[`to${which}`].value = signed ? 0 : range.high;
  fields[`scale${which}`].value = range.kind === "log" ? "log" : "linear";
}

function axis(data, which) {
  const entry = { from: Number(data.get(`from${which}`)), to: Number(data.get(`to${which}`)), count: Number(data.get(`count${which}`)) };
  if (data.get(`scale${which}`) === "log") entry.scale = "log";
  return entry;
}

async function start() {
  const data = new FormData(by("sweep")), problem = by("sweep-problem"), over = { [data.get("path")]: axis(data, "") };
  if (data.get("path2")) over[data.get("path2")] = axis(data, "2");
  problem.hidden = true;
  const refused = (text) => { problem.textContent = text; problem.hidden = false; };
  try {
    const answer = await request("/api/jobs", { body: { client, kind: "sweep", system: described().system, over, metrics: [data.get("metric")], points: "grid" } });
    if (answer.ok === false) return refused([answer.problem.where, answer.problem.problem, answer.problem.remedy].filter(Boolean).join(": "));
    jobs.set(answer.job.id, { title: `${data.get("metric")} over ${Object.keys(over).join(" and ")}` });
    return watch(answer.job, tell);
  } catch (failure) { return refused(failure.message); }
}

function tell(job) {
  Object.assign(jobs.get(job.id), { job });
  list();
  if (job.state === "done") open(job.id);
}

function list() {
  by("study-jobs").replaceChildren(...[...jobs].reverse().map(([id, { title, job }]) => el("div", { class: "job", "data-state": job.state }, el("span", { class: "name" }, title),
    ended(job) ? el("span", { class: "note" }, job.state === "failed" ? [job.error?.where, job.error?.problem].filter(Boolean).join(": ") : job.state)
      : el("progress", { max: 1, value: job.fraction ?? 0, "aria-label": title }),
    !ended(job) && el("span", { class: "note" }, job.seconds_left ? `${show(job.seconds_left, "s", 2)} left` : job.state),
    !ended(job) && el("button", { type: "button", class: "quiet", onclick: () => request(`/api/jobs/${id}`, { method: "DELETE" }).catch(() => {}) }, "Cancel"),
    job.state === "done" && el("button", { type: "button", class: "quiet", onclick: () => open(id) }, "Show"),
    job.state === "done" && el("a", { href: `/api/jobs/${id}/file`, download: "" }, "NetCDF"))));
}

async function open(id) {
  try {
    const result = await request(`/api/jobs/${id}/result`);
    const plot = el("div", { id: "study-plot" });
    by("study-result").replaceChildren(plot, ...result.failures.slice(0, 1).map(() => el("p", { class: "note" }, `${result.failures.length} of the cases could not be solved: ${result.failures[0].reason}`)));
    draw(plot, result);
  } catch (failure) { by("study-result").replaceChildren(el("p", { class: "problem" }, failure.message)); }
}

function draw(plot, { coordinates, metrics: [metric] }) {
  const [first, second] = coordinates;
  const largest = Math.max(...metric.values.flat().map((value) => Math.abs(value ?? 0)));
  const scale = prefixed(metric.unit, largest), logarithmic = (axis) => (axis.values.length > 2 && axis.values[0] > 0 && axis.values.at(-1) / axis.values[0] > 100 ? "log" : "linear");
  const name = (axis) => `${axis.label ?? axis.name}${axis.unit && axis.unit !== "1" ? ` (${pretty(axis.unit)})` : ""}`;
  const divided = (values) => values.map((value) => (Array.isArray(value) ? divided(value) : value === null ? null : value / scale.factor));
  const label = `${metric.label ?? metric.name} (${scale.unit || "–"})`;
  const { style, axis, layout } = frame({ height: 360, hovermode: "closest" });
  const trace = second
    ? { type: "heatmap", x: first.values, y: second.values, z: divided(metric.values[0].map((_, j) => metric.values.map((line) => line[j]))), colorscale: "Viridis", colorbar: { title: { text: label, side: "right" } } }
    : { type: "scatter", mode: "lines+markers", x: first.values, y: divided(metric.values), line: { color: colour("current"), width: 1.6 }, marker: { size: 5 } };
  Object.assign(layout, { xaxis: { ...axis, type: logarithmic(first), title: { text: name(first), font: style } }, yaxis: { ...axis, type: second ? logarithmic(second) : "linear", title: { text: second ? name(second) : label.replace(", ", "<br>"), font: style } }, margin: { l: 84, r: 20, t: 12, b: 52 } });
  window.Plotly.newPlot(plot, [trace], layout, SETTINGS);
}
