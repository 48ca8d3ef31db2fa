// What the forms of sweeps and optimisations share: fields that can be varied, metrics with their units, labelled inputs.
import { by, el } from "./dom.js";
import { shellCount } from "./form.js";
import { read } from "./paths.js";
import { rangeOf, span } from "./ranges.js";
import { editable, pretty } from "./units.js";
import { regionSide, shellName } from "./words.js";

// Every number of the form, those with a slider first; with `each`, the absorbers one by one too.
export function fields(each = false) {
  const found = [...by("form").querySelectorAll("input[data-unit]")].map((input) => ({ path: input.dataset.path, unit: input.dataset.unit, label: spelt(input.dataset.path) }))
    .filter(({ path }) => !/\.(time|pressure)$|^resolution\./.test(path)).sort((a, b) => Boolean(rangeOf(b.path)) - Boolean(rangeOf(a.path)));
  const own = each ? found.filter(({ path }) => /^absorbers(\[0\])?\.(mass|damping|linear_stiffness|cubic_stiffness|z)$/.test(path))
    .map(({ path, unit }) => { const name = path.split(".").at(-1); return { path: `absorbers[*].${name}`, unit, label: `each absorber’s ${spelt(name)}` }; }) : [];
  return [...found, ...own];
}

// A dotted path, or a text that holds some, with the names that the form gives to shells, layers and fluids.
export function spelt(text) {
  const shells = shellCount();
  return text.replace(/\bshells\[(\d+)\]/g, (_, i) => shellName(Number(i), shells)).replace(/\bfluids\[(\d+)\]/g, (_, i) => regionSide(Number(i), shells))
    .replace(/\b(layer|absorber)s\[(\d+)\]/g, (_, name, i) => `${name} ${Number(i) + 1}`).replace(/\bcontrol\[(\d+)\]/g, (_, i) => `law ${Number(i) + 1}`).replace(/(?<=[a-z\d])\.(?=[a-z])/gi, " · ").replaceAll("_", " ");
}

export const unitOf = (path) => fields(true).find((field) => field.path === path)?.unit ?? "";

// Whether a path is of a law whose layers have electrodes, whose gains are some ten thousand times smaller than those of the paper's.
const byElectrodes = (system, path) => path.startsWith("control") && read(system, path.replace(/\.\w+$/, "")).transducers === "electrodes";

// From, to and spacing for a field, as a person would type them.
export function suggested(system, path) {
  const value = read(system, path.replace("[*]", Array.isArray(system.absorbers) ? "[0]" : "")), unit = unitOf(path), { from, to, scale } = span(path, Number(value) || 0, byElectrodes(system, path));
  return { from: editable(from, unit), to: editable(to, unit), scale };
}

// Options of a select; one that is chosen but no longer offered stays, so that nothing changes by itself.
export function options(items, chosen) {
  const known = items.some(({ value }) => value === chosen) || chosen === undefined || chosen === "";
  return [...items, ...(known ? [] : [{ value: chosen, label: `${chosen} (not in this system)` }])].map(({ value, label }) => el("option", { value, selected: value === chosen }, label));
}

export const pathOptions = (chosen, each) => options(fields(each).map(({ path, label }) => ({ value: path, label })), chosen);
export const metricOptions = (metrics, chosen) => options((metrics ?? []).map((name) => ({ value: name, label: spelt(name) })), chosen);
// The metric offered first: the peak stress of the innermost shell.
export const firstMetric = (metrics) => (metrics ?? []).find((name) => name.endsWith(".peak_stress")) ?? metrics?.[0] ?? "inner.peak_stress";
export const spacing = (chosen, list = false) => options([{ value: "linear", label: "even" }, { value: "log", label: "logarithmic" }, ...(list ? [{ value: "list", label: "a list of choices" }] : [])], chosen);

export const labelled = (text, input) => el("label", {}, el("span", {}, text), input);
export const typed = (name, value, more = {}) => el("input", { type: "text", name, value, size: 10, spellcheck: "false", autocomplete: "off", ...more });
export const choose = (name, inner, more = {}) => el("select", { name, ...more }, ...inner);

export const withUnit = (text, unit) => (unit && unit !== "1" ? `${text} (${pretty(unit)})` : text);

// The unit of a metric by its name, as /api/schema tells it.
export function metricUnit(world, name) {
  return world.metric_units[name] ?? world.metric_units[name.split(".").at(-1)] ?? "1";
}

