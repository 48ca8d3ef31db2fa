// Optimisations: what may change, what to make small, which limits to keep; the search itself is the server's.
import { by, el } from "./dom.js";
import { show as showOptimum } from "./optimum.js";
import { choose, fields, firstMetric, labelled, metricOptions, metricUnit, options, pathOptions, spacing, spelt, suggested, typed, unitOf, withUnit } from "./study_fields.js";
import { numeral, plain, pretty } from "./units.js";
import { told } from "./words.js";

export const title = "Optimise", start = "Start optimisation";
export const show = showOptimum;

const GOALS = [{ value: "min", label: "as small as possible" }, { value: "max", label: "as large as possible" }];
const SIGNS = [{ value: "<=", label: "at most (≤)" }, { value: ">=", label: "at least (≥)" }];
const METHODS = [["auto", "automatic"], ["cma-es", "CMA-ES"], ["differential-evolution", "differential evolution"], ["nsga2", "NSGA-II"], ["gradient", "gradients"]].map(([value, label]) => ({ value, label }));
const EACH = [{ value: "mirror", label: "mirror images" }, { value: "single", label: "none" }];
const FIRST = ["absorbers.mass", "absorbers.damping", "control.proportional", "control[0].proportional"];
let described, form;
const study = { variables: [], objectives: [{ metric: null, goal: "min" }, { metric: "", goal: "min" }], constraints: [], evaluations: "100", method: "auto", population: "", seed: "0" };

export function setUp(box, current) {
  [form, described] = [box, current];
  form.addEventListener("input", ({ target }) => keep(target));
  form.addEventListener("change", ({ target }) => keep(target));
}

export function offer() {
  const { system } = described();
  if (!study.variables.length) study.variables = [variable(system, FIRST.find((path) => fields().some((field) => field.path === path)) ?? fields()[0]?.path)].filter(({ path }) => path);
  study.objectives[0].metric ??= firstMetric(described().metrics);
  draw();
}

const variable = (system, path) => ({ path, each: "mirror", values: "", ...(path ? suggested(system, path) : {}) });
const ofEach = ({ path }) => path.includes("[*]");
const isList = (one) => one.scale === "list" && !ofEach(one);

// What a person typed or chose goes into the study under the input's own name, such as variables.0.from.
function keep(input) {
  const [part, number, entry] = input.name.split(".");
  if (!(part in study)) return;
  if (number === undefined) { study[part] = input.value; return; }
  study[part][number][entry] = input.value;
  if (entry === "path") study.variables[number] = variable(described().system, input.value);
  if (entry === "scale" && input.value === "list") study.variables[number].values ||= `${study.variables[number].from}; ${study.variables[number].to}`;
  if (["path", "metric", "scale"].includes(entry)) draw(input.name);
}

// ---- the form

function draw(focused = document.activeElement?.name) {
  const { metrics } = described();
  form.replaceChildren(
    set("Change", "variables", study.variables.map(variableRow), study.variables.length < 8 && add("Add a variable", () => { study.variables.push(variable(described().system, unused())); return "variables"; })),
    set("Make", "objectives", study.objectives.map((one, i) => objectiveRow(one, i, metrics))),
    set("Keep", "constraints", study.constraints.map((one, i) => constraintRow(one, i, metrics)), study.constraints.length < 12 && add("Add a limit", () => { study.constraints.push({ metric: metrics?.includes("absorbers.mass") ? "absorbers.mass" : metrics?.[0], sign: "<=", value: "" }); return "constraints"; })),
    set("Search", "search", [el("div", { class: "row" }, labelled("Designs to try", typed("evaluations", study.evaluations, { inputmode: "numeric", size: 6 })),
      labelled("Method", choose("method", options(METHODS, study.method))), labelled("In a generation", typed("population", study.population, { inputmode: "numeric", placeholder: "automatic" })), labelled("Seed", typed("seed", study.seed, { inputmode: "numeric", size: 6 })))]),
    el("div", { class: "buttons" }, el("button", { class: "main" }, start)), el("p", { class: "problem", id: "optimise-problem", role: "alert", hidden: true }));
  if (focused) form.elements[focused]?.focus?.({ preventScroll: true });
}

function set(legend, name, rows, more) {
  return el("fieldset", { "data-part": name }, el("legend", {}, legend), ...rows, more);
}

function add(text, work) {
  return el("div", { class: "buttons" }, el("button", { type: "button", onclick: () => { const part = work(); draw(`${part}.${study[part].length - 1}.${part === "variables" ? "path" : "metric"}`); } }, text));
}

function remove(part, i, what) {
  return el("button", { type: "button", class: "quiet remove", "aria-label": `Remove ${what}`, onclick: () => { study[part].splice(i, 1); draw(); (form.querySelectorAll(`[data-part="${part}"] button`)[0])?.focus(); } }, "Remove");
}

const unused = () => fields().map(({ path }) => path).find((path) => !study.variables.some((one) => one.path === path));

function variableRow(one, i) {
  const unit = unitOf(one.path), name = (entry) => `variables.${i}.${entry}`;
  return el("div", { class: "row", role: "group", "aria-label": `Variable ${i + 1}` }, labelled("What", choose(name("path"), pathOptions(one.path, true))),
    ofEach(one) && labelled("Alike", choose(name("each"), options(EACH, one.each))),
    ...(isList(one) ? [labelled(withUnit("Choices, with ; between", unit), typed(name("values"), one.values, { size: 24 }))]
      : [labelled(withUnit("From", unit), typed(name("from"), one.from)), labelled(withUnit("To", unit), typed(name("to"), one.to))]),
    labelled("Spacing", choose(name("scale"), spacing(one.scale, !ofEach(one)))),
    study.variables.length > 1 && remove("variables", i, spelt(one.path)));
}

function objectiveRow({ metric, goal }, i, metrics) {
  const name = (entry) => `objectives.${i}.${entry}`;
  return el("div", { class: "row", role: "group", "aria-label": i ? "Second objective" : "Objective" },
    labelled(i ? "And (optional: a front of both)" : "Metric", choose(name("metric"), [...(i ? [el("option", { value: "" }, "nothing else")] : []), ...metricOptions(metrics, metric)])),
    (!i || metric) && labelled("Goal", choose(name("goal"), options(GOALS, goal))));
}

function constraintRow(one, i, metrics) {
  const unit = metricUnit(described().world, one.metric), name = (entry) => `constraints.${i}.${entry}`;
  return el("div", { class: "row", role: "group", "aria-label": `Limit ${i + 1}` }, labelled("Metric", choose(name("metric"), metricOptions(metrics, one.metric))),
    labelled("Is", choose(name("sign"), options(SIGNS, one.sign))), labelled(withUnit("Limit", unit), typed(name("value"), one.value, { placeholder: unit === "1" ? "" : `… ${pretty(unit)}` })),
    remove("constraints", i, `the limit on ${spelt(one.metric)}`));
}

// ---- what is asked

export function body() {
  const variables = Object.fromEntries(study.variables.map((one) => [one.path, isList(one) ? one.values.split(";").filter((text) => text.trim()).map(numeral)
    : { from: numeral(one.from), to: numeral(one.to), ...(one.scale === "log" ? { scale: "log" } : {}), ...(ofEach(one) ? { each: one.each } : {}) }]));
  const objectives = study.objectives.filter(({ metric }) => metric).map(({ metric, goal }) => (goal === "max" ? { metric, maximise: true } : metric));
  const constraints = study.constraints.map(({ metric, sign, value }) => `${metric} ${sign} ${limit(value, metricUnit(described().world, metric))}`);
  const population = study.population.trim() ? { population: numeral(study.population) } : {};
  return { kind: "optimise", variables, objectives, constraints, evaluations: numeral(study.evaluations), method: study.method, ...population, seed: numeral(study.seed) };
}

// What the library would tell in words of its text rather than of the form.
export function missing() {
  const empty = study.constraints.findIndex(({ value }) => !value.trim());
  return empty < 0 ? null : { where: `constraints[${empty}]`, problem: "the limit is empty", remedy: "give its value, or remove it" };
}

const limit = (text, unit) => (typeof numeral(text) === "number" && unit !== "1" ? `${numeral(text)} ${unit}` : plain(text));

export function named({ objectives, variables }) {
  return `${objectives.map((one) => `${one.maximise ? "largest" : "smallest"} ${spelt(one.metric ?? one)}`).join(" against ")} by ${Object.keys(variables).map(spelt).join(", ")}`;
}

// ---- what is wrong, beside its field where it has one

export function mark(_, problem) {
  for (const input of form.querySelectorAll("[aria-invalid]")) { input.removeAttribute("aria-invalid"); input.removeAttribute("aria-describedby"); }
  const box = by("optimise-problem");
  box.hidden = !problem;
  form.append(box);
  if (!problem) return;
  const spot = place(problem.where);
  box.textContent = told(spot?.closest(".row") ? { ...problem, where: "" } : problem);
  if (!spot) return;
  (spot.closest(".row") ?? spot).after(box);
  for (const input of spot.matches("input, select") ? [spot] : []) { input.setAttribute("aria-invalid", "true"); input.setAttribute("aria-describedby", box.id); input.focus(); }
}

function place(where) {
  const variable = study.variables.findIndex(({ path }) => [".", "["].some((next) => `${where}${next}`.startsWith(`variables.${path}${next}`)) || (path.includes("[*]") && where.replace(/\[\d+\]/, "[*]").startsWith(`variables.${path}`)));
  if (variable >= 0) return form.elements[`variables.${variable}.${isList(study.variables[variable]) ? "values" : where.match(/\.(from|to|scale|each)$/)?.[1] ?? "from"}`];
  const [, part, number] = where.match(/^(objectives|constraints)\[(\d+)\]/) ?? [];
  if (part) return form.elements[`${part}.${number}.${part === "objectives" ? "metric" : "value"}`];
  if (["evaluations", "method", "population", "seed"].includes(where)) return form.elements[where];
  return form.querySelector(`[data-part="${where}"] > .row:last-of-type`);
}
