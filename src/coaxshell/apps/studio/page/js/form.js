// The form, generated from the description's own schema: one function a kind of entry.
import * as building from "./building.js";
import { el, by } from "./dom.js";
import * as laws from "./laws.js";
import { join, read } from "./paths.js";
import { handleAt, rangeOf, steps, valueAt } from "./ranges.js";
import { editor } from "./record.js";
import { fresh, kinds, kindTitle, limits, matches, resolve, use } from "./schema.js";
import { costText, digest, spatial } from "./space.js";
import { editable, numeral, show } from "./units.js";
import { capital, inWords, regionSide, shellName, shellPhrase, title } from "./words.js";

const ORDER = ["absorbers", "control", "shells", "source", "sea", "fluids", "name"];
const OPEN = new Set(["absorbers", "control"]);
const KEPT_OPEN = new Map();
const SAMPLES = new Set(["time", "pressure"]);
const OFF_THE_PLANE = new Set(["z", "inclination"]); // of sources: shown in three dimensions, and where a description has them

let world, change, now, shells = 1, space = false; // what /api/schema says; (path, value, { live }) => void; () => system; how many shells there are; in three dimensions
let costs = null; // of the run as it is, and with other choices
let wanted = null; // what has the focus once the form is made anew: an action of an item, or else the item

export function setUp(known, onChange, present) {
  world = known;
  change = (path, value, how) => onChange(...laws.together(path, value, present().control), how);
  now = present;
  use(known.schema);
}

export const shellCount = () => shells;

export function render(system, problems) {
  const form = by("form");
  shells = Array.isArray(system.shells) ? system.shells.length : 1;
  space = spatial(system.resolution);
  costs = system.costs;
  const focus = document.activeElement?.dataset?.path;
  const parts = resolve(world.schema).properties;
  const names = [...ORDER, ...Object.keys(parts).filter((name) => !ORDER.includes(name))];
  form.replaceChildren(dimensions(system.resolution), ...names.filter((name) => name in parts).map((name) => section(name, parts[name], system[name])), resolution(system.resolution));
  mark(problems);
  if (wanted) {
    const { act, item } = wanted, box = form.querySelector(`[data-group="${CSS.escape(item)}"]`);
    wanted = null;
    const list = item.replace(/\[\d+\]$/, ""); // of two laws one is left, which is no list
    (form.querySelector(`[data-act="${CSS.escape(act)}"]:not(:disabled)`) ?? box?.querySelector(":scope > summary, select") ?? form.querySelector(`select[data-path="${CSS.escape(list)}"]`))?.focus();
  } else if (focus) form.querySelector(`[data-path="${focus}"]`)?.focus({ preventScroll: true });
}

// Bring the inputs up to date without making them anew: a slider under a finger stays where it is.
export function refresh(system) {
  const sliders = new Map([...by("form").querySelectorAll('input[type="range"]')].map((one) => [one.dataset.path, one]));
  for (const input of by("form").querySelectorAll("input[data-unit]")) {
    const value = read(system, input.dataset.path);
    if (input !== document.activeElement) input.value = typedAs(value, input.dataset.unit);
    const slider = sliders.get(input.dataset.path);
    if (slider && typeof value === "number") place(slider, value, input.dataset.unit);
  }
  for (const box of by("form").querySelectorAll("[data-record]")) box.replaceWith(editor(box.dataset.record, change));
  for (const text of by("form").querySelectorAll(".digest")) text.textContent = summary(text.dataset.of, text.dataset.of === "dimensions" ? system.resolution : read(system, text.dataset.of));
  if (by("cost")) by("cost").textContent = costText(system.costs);
  costs = system.costs;
  for (const option of by("form").querySelectorAll("[data-cost]")) option.textContent = option.dataset.words + costWords(option.dataset.cost);
}

// A choice with what the run would take: "dimensions/3", or the theory of a wall, "theory/0/elastic".
const costed = (cost, value, words, selected) => el("option", { value, selected, "data-cost": cost, "data-words": words }, words + costWords(cost));

function costWords(choice) {
  if (costs?.dimensions === undefined) return "";
  const [kind, which, theory] = choice.split("/"), mine = kind === "dimensions" ? Number(which) === (space ? 3 : 2) : now().shells[which]?.theory === theory;
  const cost = mine ? costs.full : kind === "dimensions" ? costs.dimensions : costs.theories[which];
  return cost ? ` (${cost.duration.replace(" ", "\u202f")})` : " (not solved)";
}

function group(path, name, open, text, ...body) {
  const known = KEPT_OPEN.get(path);
  const box = el("details", { "data-group": path, open: known ?? open, ontoggle: () => KEPT_OPEN.set(path, box.open) },
    el("summary", {}, el("span", {}, name), el("span", { class: "digest", "data-of": path }, text)), el("div", { class: "body" }, ...body));
  return box;
}

function section(name, schema, value) {
  return group(name, title(name), OPEN.has(name), summary(name, value), entry(schema, name, name, value, true));
}

const RESOLUTION = {
  duration: { type: "number", unit: "", description: "How long, in transits a/c of the outermost radius" },
  time_step: { type: "number", unit: "", description: "Time step, in transits; the preview takes a coarser one" },
  modes: { type: "integer", unit: "", description: "Circumferential orders; the preview takes at most 60" },
  refinement: { type: "integer", unit: "", description: "Steps of the absorbers’ march within one time step" },
};

// What is not solved here, told before it is asked for.
const MOST = {
  "absorbers.count": ({ absorbers }) => `at most ${absorbers}`,
  "resolution.modes": ({ modes }) => `at most ${modes}`,
  "resolution.time_step": ({ steps }) => `at most ${steps.toLocaleString("en")} steps of all refinement`,
  "resolution.refinement": ({ refinement }) => `at most ${refinement}`,
};

const WAVES = {
  axial_modes: { type: "number", unit: "", optional: true, exclusiveMinimum: 0, description: "Highest axial wavenumber times the outermost radius; as many as there are orders unless given" },
  axial_period: { type: "number", unit: "m", optional: true, exclusiveMinimum: 0, description: "Distance after which the answer repeats along the axis; what causality asks unless given" },
};

// Two dimensions or three, and with three where along the axis, and what it costs.
function dimensions(value) {
  const select = el("select", { id: "at-resolution.dimensions", "data-path": "resolution.dimensions", onchange: () => change("resolution.dimensions", Number(select.value)) },
    ...[[2, "two: alike along the axis"], [3, "three: at stations"]].map(([number, text]) => costed(`dimensions/${number}`, number, text, number === (space ? 3 : 2))));
  const choice = el("div", { class: "choice long" }, el("label", { for: select.id }, "Dimensions"), select);
  if (!space) return group("dimensions", "Dimensions", false, digest(value), choice, el("p", { class: "hint", id: "cost" }, costText(costs)));
  const stations = leaf({ long: true, type: "string", list: true, description: "Axial positions at which the shells answer, such as 0, 70 cm" }, "resolution.stations", "stations", [value.stations ?? 0].flat().join(", "));
  return group("dimensions", "Dimensions", true, digest(value), choice, stations, el("p", { class: "hint" }, `At most ${world.limits.stations}, in m or as text, with commas between: 0, 0.25, 70 cm.`),
    ...Object.entries(WAVES).map(([name, schema]) => leaf(schema, `resolution.${name}`, name, value[name])), el("p", { class: "hint", id: "cost" }, costText(costs)));
}

function resolution(value) {
  return group("resolution", "Resolution", false, summary("resolution", value), ...Object.entries(RESOLUTION).map(([name, schema]) => leaf({ ...schema, exclusiveMinimum: 0 }, `resolution.${name}`, name, value[name])));
}

// One line that tells what a closed group holds.
function summary(path, value) {
  if (value === null || value === undefined || (Array.isArray(value) && !value.length)) return "none";
  if (typeof value === "string") return value;
  if (/^absorbers$/.test(path)) return Array.isArray(value) ? `${value.length} single` : `${value.count} equal`;
  if (/^fluids/.test(path)) return (Array.isArray(value) ? value : [value]).map((fluid) => fluid.name || (fluid === "vacuum" ? fluid : "own")).filter((n, i, all) => n !== all[i - 1]).join(", ");
  if (/^shells$/.test(path)) return value.map((shell) => show(shell.radius, "m", 3)).join(", ");
  if (/^shells\[\d+\]$/.test(path)) return show(value.radius, "m");
  if (/layers\[\d+\]$/.test(path)) return `${show(value.thickness, "m")} ${value.material?.name ?? ""}${value.role && value.role !== "core" ? `, ${value.role}` : ""}`;
  if (path === "dimensions") return digest(value);
  if (/^absorbers\[\d+\]$/.test(path)) return "z" in value ? `${show(value.angle ?? 0, "deg")}, z = ${show(value.z, "m")}, ${show(value.mass, "kg")}` : `${show(value.angle ?? 0, "deg")}, ${show(value.mass, "kg/m")}`;
  if (/^source$/.test(path)) return Array.isArray(value) ? `${value.length} sources` : title(value.type.replace(/-/g, " ").toLowerCase());
  if (path === "resolution") return `${value.modes} orders, step ${value.time_step}`;
  if (/^sea$/.test(path)) return `${show(value.depth, "m", 3)} deep`;
  if (/^control/.test(path)) return Array.isArray(value) ? `${value.length} laws` : laws.digest(value, shells);
  return value.name ?? value.type ?? "";
}

function entry(schema, path, name, value, bare = false) {
  const found = resolve(schema);
  const choices = kinds(found);
  if (/(^|\.)fluids\[\d+\]$/.test(path)) return library(path, name, value, choices, world.fluids, "fluid", "name");
  if (/\.material$/.test(path)) return library(path, name, value, choices, world.materials, "material", "name");
  if (choices.length > 1) return union(found, choices, path, name, value, bare);
  const kind = { ...choices[0], description: found.description ?? choices[0].description };
  if (kind.const !== undefined || kind.type === "null") return null;
  if (kind.type === "array") return list(kind, path, name, value ?? []);
  if (kind.type === "object") return table(kind, path, name, value ?? {}, bare);
  return leaf(kind, path, name, value);
}

function table(schema, path, name, value, bare) {
  const isRecord = resolve(schema.properties?.type).const === "sampled"; // its samples are read from a file or a text, not typed one by one
  const fields = Object.entries(schema.properties ?? {}).filter(([key]) => !(isRecord && SAMPLES.has(key)) && !(OFF_THE_PLANE.has(key) && !value[key] && !space) && key !== "outer_shell").map(([key, part]) => entry(part, join(path, key), key, value[key]));
  if (isRecord) fields.unshift(editor(path, change));
  return bare ? el("div", {}, ...fields) : group(path, label(path, name), false, summary(path, value), ...fields);
}

function label(path, name) {
  const index = path.match(/(\w+)\[(\d+)\]$/);
  if (!index) return title(name);
  if (index[1] === "shells") return capital(shellPhrase(Number(index[2]), shells));
  if (index[1] === "control") return `Law ${Number(index[2]) + 1}`;
  return `${title(index[1].replace(/s$/, ""))} ${Number(index[2]) + 1}`;
}

function list(schema, path, name, value) {
  const singular = name === "control" ? "law" : name.replace(/s$/, "");
  const item = schema.items ?? {};
  const numeric = ["number", "integer"].includes(resolve(item).type);
  if (numeric) return leaf({ type: "string", list: true, description: schema.description }, path, name, Array.isArray(value) ? value.join(", ") : value);
  const items = value.map((one, i) => {
    const inner = entry(item, join(path, i), singular, one), body = inner?.querySelector?.(":scope > .body");
    (body ?? inner)?.append?.(tools(item, path, name, value, i));
    return inner;
  });
  const most = mostOf(name, value), full = value.length >= most;
  return el("div", { "data-group": path }, ...items, path === "fluids" ? null : el("div", { class: "buttons" },
    el("button", { type: "button", disabled: full, onclick: () => add(item, path, name, Infinity) }, `Add ${singular}`), full ? el("small", { class: "hint" }, name === "control" ? "every shell that senses has its law" : `at most ${most}`) : null));
}

const mostOf = (name, value) => ({ control: name === "control" && value.length + Math.min(1, laws.free(value, now().shells).length), shells: world.limits.shells, layers: world.limits.layers, absorbers: world.limits.absorbers, source: world.limits.sources })[name] ?? Infinity;

// What can be done with an item: exchanged with its neighbours, copied to the next place, taken out. Fluids follow the shells.
function tools(item, path, name, value, i) {
  const at = join(path, i), of = label(at, name), radial = ["shells", "layers", "fluids"].includes(name), [before, after] = radial ? ["inwards", "outwards"] : ["before the one above", "after the one below"];
  const button = (act, words, text, onclick, more = {}) => el("button", { type: "button", "data-act": `${at}:${act}`, "aria-label": words, title: words, onclick, ...more }, text);
  return el("div", { class: "buttons" },
    i > 0 && button("in", `Move ${of} ${before}`, "↑", () => exchange(path, i, i - 1, "in")),
    i < value.length - 1 && button("out", `Move ${of} ${after}`, "↓", () => exchange(path, i, i + 1, "out")),
    path !== "fluids" && button("copy", `Add a copy of ${of}`, "Copy", () => add(item, path, name, i), { disabled: value.length >= mostOf(name, value) }),
    path !== "fluids" && (value.length > 1 || name === "absorbers") && button("remove", `Remove ${of}`, "Remove", () => remove(path, i)));
}

// What there is now: a second press may come before the form shows what the first one did.
const present = (path) => read(now(), path) ?? [];

// The new item is open and has the focus. A shell takes its place among fluids, absorbers and control.
function add(item, path, name, place) {
  const value = present(path), after = Math.min(place, value.length - 1);
  if (value.length >= mostOf(name, value)) return null;
  const at = join(path, after + 1);
  wanted = { act: "", item: at };
  for (let i = value.length; i > after + 1; i -= 1) opened(join(path, i), join(path, i - 1));
  KEPT_OPEN.set(at, true);
  if (path === "shells") return change("", building.withShellAfter(now(), after));
  return change(path, [...value.slice(0, after + 1), following(item, value[after], value), ...value.slice(after + 1)]);
}

function remove(path, i) {
  const value = present(path);
  wanted = { act: `${join(path, Math.min(i, value.length - 2))}:remove`, item: join(path, Math.max(0, Math.min(i, value.length - 2))) };
  for (let k = i; k < value.length - 1; k += 1) opened(join(path, k), join(path, k + 1));
  return path === "shells" ? change("", building.withoutShell(now(), i)) : change(path, value.filter((_, k) => k !== i));
}

function exchange(path, i, j, act) {
  const value = present(path), [a, b] = [join(path, i), join(path, j)], was = KEPT_OPEN.get(a);
  wanted = { act: `${b}:${act}`, item: b };
  if (Math.max(i, j) >= value.length) return null;
  opened(a, b);
  KEPT_OPEN.set(b, was ?? false);
  if (path === "shells") return change("", building.withWallsExchanged(now(), Math.min(i, j)));
  const copy = [...value];
  [copy[i], copy[j]] = [copy[j], copy[i]];
  return change(path, copy);
}

// Whether an item is open goes with it to its new place.
function opened(to, from) { KEPT_OPEN.set(to, KEPT_OPEN.get(from) ?? false); }

// A further item starts as the one before it; what there is once in a wall, or at a place, is not there twice.
function following(item, before, value) {
  const copy = structuredClone(before ?? fresh(itemHere(item), HINTS));
  if ("shells" in copy) return laws.following(copy, value, now().shells);
  if ("inner_shell" in copy) copy.angle = building.freeAngle(value, copy);
  else if (typeof copy.angle === "number") copy.angle = building.turned(copy.angle + 30);
  if (["sensor", "actuator", "self-sensing"].includes(copy.role)) copy.role = "passive";
  return copy;
}

// A first single absorber, on a line or in three dimensions at a point.
export const newAbsorber = () => fresh(itemHere(kinds(resolve(world.schema).properties.absorbers).find(({ type }) => type === "array").items), HINTS);

const HINTS = {
  z: 0,
  count: 25, mass: 10, damping: 1e6, linear_stiffness: 1e9, cubic_stiffness: 1e20, stiffness: 1e9, clearance: 1e-6, force: 1e4, relaxation_time: 1e-4, k3: 1e20, proportional: -2e4, derivative: -150, numerator: [-0.1, -2e4], denominator: [1],
  distance: 5, peak_pressure: 2.5e4, decay_time: 1.314e-4, width: 1e-4, pressure: 2.5e4, charge_mass: 1, stand_off: 10,
  depth: 20, density: 1000, sound_speed: 1500, youngs_modulus: 7e10, poisson_ratio: 0.3, thickness: 0.006,
};

function union(schema, choices, path, name, value, bare) {
  let chosen = choices.findIndex((kind) => matches(kind, value));
  if (chosen < 0) chosen = choices.findIndex((kind) => kind.type !== "null");
  const numeric = !choices.some((kind) => kind.type === "array") && choices.find((kind) => ["number", "integer"].includes(kind.type));
  if (numeric && choices.some((kind) => kind.type === "null")) return leaf({ ...numeric, optional: true, description: schema.description }, path, name, value);
  if (/^control.*\.shells$/.test(path)) return laws.shellBoxes(path, value, now().shells, change);
  if (/^control.*\.matrix$/.test(path)) return leaf({ type: "string", list: name, long: true, description: `${schema.description} Such as 1, 0.3; 0.6, 1.` }, path, name, (value ?? []).map((row) => row.join(", ")).join("; "));
  if (/^control.*\.dead_electrodes$/.test(path)) return leaf({ type: "string", list: name, description: `${schema.description} Such as 0, 3; -1, 5.` }, path, name, (value ?? []).map((pair) => pair.join(", ")).join("; "));
  if (/^control.*\.(weights|dead|dead_belts)$/.test(path)) return leaf({ type: "string", list: name, description: schema.description }, path, name, [value ?? []].flat().join(", "));
  const id = `kind-${path}`;
  const none = Array.isArray(value) && !value.length && choices.some((kind) => kind.type === "array");
  const lacking = path === "control" && !Array.isArray(value) && laws.controllable(now().shells).length < 2; // one law each takes two shells that sense
  const options = choices.map((kind, i) => el("option", { value: i, selected: i === chosen && !none, disabled: kind.type === "array" && lacking }, kind.type === "null" ? "None" : kind.type === "array" ? (path === "control" ? "One law for each shell" : "Several, one by one") : kindTitle(kind)));
  if (path === "absorbers") options.unshift(el("option", { value: "none", selected: none }, "None"));
  const select = el("select", { id, "data-path": path, onchange: () => change(path, start(select.value, choices, read(now(), path), path)) }, ...options);
  const inner = none ? null : entry(choices[chosen], path, name, value, true);
  const choice = el("div", { class: "choice" }, el("label", { for: id }, "Kind"), select);
  return bare ? el("div", { "data-group": path }, choice, inner) : group(path, label(path, name), false, summary(path, value), choice, inner);
}

// The first value of another kind keeps what the two have in common.
function start(index, choices, value, path) {
  if (index === "none") return [];
  const kind = choices[index];
  if (kind.type === "array" && path === "control") return eachItsLaw(value ?? fresh(choices[0], HINTS));
  if (kind.type === "array") return value && !Array.isArray(value) ? building.singly(value, space ? { z: 0 } : {}) : [fresh(itemHere(kind.items), HINTS)];
  const kept = Array.isArray(value) ? (value[0] ?? {}) : value && typeof value === "object" ? value : {};
  const common = Object.fromEntries(Object.entries(kept).filter(([key]) => key !== "type"));
  const fits = ([key, one]) => kinds(kind.properties?.[key] ?? {}).some((part) => matches(part, one));
  const made = fresh(kind, { ...HINTS, ...Object.fromEntries(Object.entries(common).filter(fits)), ...laws.turned(kept, now()), ...(resolve(kind.properties?.type).const === "sampled" ? sampled(kept) : {}) });
  if (kind.type === "object" && Array.isArray(value) && "count" in made) made.count = value.length;
  if (resolve(kind.properties?.pulse).anyOf && !made.pulse?.type) made.pulse = { type: "exponential", peak_pressure: kept.peak_pressure ?? HINTS.peak_pressure, decay_time: kept.decay_time ?? HINTS.decay_time };
  return made;
}

function eachItsLaw(law) {
  const several = laws.split(law, now().shells);
  several.forEach((_, i) => KEPT_OPEN.set(join("control", i), true));
  return several;
}

// An exponential pulse as a record to begin with.
function sampled({ peak_pressure = HINTS.peak_pressure, decay_time = HINTS.decay_time }) {
  const time = Array.from({ length: 61 }, (_, i) => Number(((i * decay_time) / 10).toPrecision(6)));
  return { time, pressure: time.map((t) => Number((peak_pressure * Math.exp(-t / decay_time)).toPrecision(6))) };
}

// What a new item of a list is: in three dimensions an absorber at a point.
const itemHere = (item) => (space && kinds(item).find((kind) => kind.required?.includes("z"))) || item;

// A fluid or material: one of the library's by name, or constants of one's own.
function library(path, name, value, choices, known, entryName, key) {
  const id = `lib-${path}`;
  const named = known.findIndex((item) => item[entryName] === value || (value && same(item[entryName], value)));
  const own = named < 0 ? el("option", { value: "", selected: true }, value?.[key] ? `${value[key]} (own)` : "own") : null;
  const select = el("select", { id, "data-path": path, onchange: () => select.value !== "" && choose(path, known[select.value]) },
    own, ...known.map((item, i) => el("option", { value: i, selected: i === named, title: item.reference }, item.name)));
  const line = el("div", { class: "field" }, el("label", { for: id }, entryName === "fluid" ? capital(regionSide(Number(path.match(/\[(\d+)\]$/)[1]), shells)) : "Material"), select);
  const kind = choices.find((one) => matches(one, value)) ?? choices[0];
  const constants = value && typeof value === "object" ? group(`${path}.constants`, "Constants", false, "", table(kind, path, name, value, true)) : null;
  return el("div", { "data-group": path }, line, constants);
}

// A layer that becomes piezoelectric, or ceases to be, takes a role that its material can have.
function choose(path, { fluid, material, kind }) {
  const at = path.replace(/\.material$/, ""), layer = material && read(now(), at), electric = ["sensor", "actuator", "self-sensing"].includes(layer?.role);
  if (!layer || (kind === "piezoelectric" ? layer.role !== "core" : !electric)) return change(path, structuredClone(fluid ?? material));
  return change(at, { ...layer, material: structuredClone(material), role: kind === "piezoelectric" ? "passive" : "core" });
}

function same(a, b) {
  if (a === b) return true;
  if (!a || !b || typeof a !== "object" || typeof b !== "object") return false;
  return [...new Set([...Object.keys(a), ...Object.keys(b)])].every((key) => same(a[key] ?? null, b[key] ?? null));
}

function leaf(schema, path, name, value) {
  const id = `at-${path}`, shared = { id, "data-path": path, title: [schema.description, limits(schema)].filter(Boolean).join("\n") };
  const text = el("label", { for: id }, title(name));
  if (name === "inner_shell" && shells > 1) {
    const place = path.slice(0, path.lastIndexOf(".")), [inner, outer] = building.linkedShells(read(now(), place) ?? {});
    const pairs = Array.from({ length: shells }, (_, i) => Array.from({ length: shells - 1 - i }, (_, k) => [i, i + 1 + k])).flat().sort(([a, b], [c, d]) => b - a - (d - c) || a - c);
    const linked = () => change(place, building.between(read(now(), place), ...pairs[select.selectedIndex]));
    const select = el("select", { ...shared, onchange: linked }, ...pairs.map(([i, k]) => el("option", { value: `${i} ${k}`, selected: i === inner && k === outer }, `${shellName(i, shells)} and ${shellName(k, shells)}`)));
    return el("div", { class: "field broad" }, text, select);
  }
  if (schema.enum) {
    const select = el("select", { ...shared, onchange: () => change(path, select.value) }, ...schema.enum.map((one) => (name === "theory" ? costed(`theory/${path.match(/\d+/)}/${one}`, one, one, one === value) : el("option", { value: one, selected: one === value }, one))));
    return el("div", { class: name === "theory" ? "field broad" : "field" }, text, select);
  }
  if (schema.type === "boolean") {
    const box = el("input", { ...shared, type: "checkbox", checked: Boolean(value ?? schema.default), onchange: () => change(path, box.checked) });
    return el("div", { class: "field" }, text, box);
  }
  if (name === "explosive") {
    const select = el("select", { ...shared, onchange: () => change(path, select.value) }, ...world.explosives.map((one) => el("option", { value: one, selected: one === (value ?? schema.default) }, one)));
    return el("div", { class: "field" }, text, select);
  }
  if (schema.type === "string") {
    const input = el("input", { ...shared, type: "text", class: "name", value: value ?? schema.default ?? "", onchange: () => change(path, schema.list ? listed(input.value, schema.list) : input.value) });
    return el("div", { class: schema.long ? "field long" : "field" }, text, input);
  }
  return quantity(schema, path, text, value ?? (schema.optional ? "" : schema.default), shared);
}

// One number alone is the highest order of a modal filter, none no filter; no dead segments are none.
function listed(text, kind) {
  if (/dead|matrix/.test(kind) && text.trim() === "") return null;
  if (kind === "matrix" || kind === "dead_electrodes") return text.split(";").map((row) => row.split(",").map(numeral));
  if (kind === "weights" && !text.includes(",")) return text.trim() === "" ? null : numeral(text);
  return text.trim() === "all" ? "all" : text.split(",").map((part) => part.trim()).filter(Boolean).map((part) => (part !== "" && Number.isFinite(Number(part)) ? Number(part) : part));
}

function quantity(schema, path, text, value, shared) {
  const unit = schema.unit ?? "";
  const input = el("input", { ...shared, type: "text", inputmode: "text", spellcheck: "false", "data-unit": unit, value: typedAs(value, unit),
    placeholder: schema.optional ? ({ field_limit: "material’s own", centre: "6 widths", footprint: "as the walls ask", axial_modes: "as the orders", axial_period: "by causality" }[path.split(".").at(-1)] ?? "none") : null,
    onchange: () => change(path, schema.optional && !input.value.trim() ? null : laws.isGain(path) ? laws.gains(input.value) : numeral(input.value)) });
  const field = el("div", { class: "field" }, text, input, path in MOST ? el("small", { class: "hint" }, MOST[path](world.limits)) : null);
  const range = rangeOf(path);
  if (range && !Array.isArray(value)) {
    const slider = el("input", { type: "range", min: 0, max: steps(range), step: 1, "data-path": path, "aria-label": `${text.textContent}, slider`,
      oninput: () => {
        const next = valueAt(range, Number(slider.value));
        input.value = editable(next, unit);
        slider.setAttribute("aria-valuetext", show(next, unit));
        change(path, next, { live: true });
      } });
    place(slider, Number(value), unit);
    field.append(slider);
  }
  return field;
}

const typedAs = (value, unit) => (Array.isArray(value) ? value.join(", ") : editable(value, unit));

function place(slider, value, unit) {
  const range = rangeOf(slider.dataset.path);
  if (slider !== document.activeElement) slider.value = handleAt(range, value);
  slider.setAttribute("aria-valuetext", show(value, unit));
}

// The library's own words beside the fields they are about, or beside the nearest part around each; the first is announced.
export function mark(problems) {
  const form = by("form"), general = by("form-problem");
  for (const old of form.querySelectorAll(".problem")) old.remove();
  for (const input of form.querySelectorAll("[aria-invalid]")) { input.removeAttribute("aria-invalid"); input.removeAttribute("aria-describedby"); }
  const homeless = problems.filter((problem, i) => !beside(form, problem, i));
  general.replaceChildren(...homeless.map((problem) => el("span", {}, problem.where ? `${problem.where}: ${sentence(problem)}` : sentence(problem))));
  general.hidden = !homeless.length;
}

const sentence = ({ problem, remedy }) => inWords([problem, remedy].filter(Boolean).join("; "));

function beside(form, problem, number) {
  const spot = nearest(form, problem.where), id = number ? `field-problem-${number}` : "field-problem";
  if (!spot) return false;
  for (let box = spot.closest("details"); box; box = box.parentElement.closest("details")) box.open = true;
  const message = el("p", { class: "problem", id, role: number ? null : "alert" }, sentence(problem));
  if (spot.matches("input, select, textarea")) {
    spot.setAttribute("aria-invalid", "true");
    spot.setAttribute("aria-describedby", id);
    if (spot.parentElement.matches(".choice")) spot.parentElement.after(message);
    else spot.parentElement.append(message);
  } else (spot.querySelector(":scope > .body") ?? spot).prepend(message);
  return true;
}

function nearest(form, where) {
  for (let path = where; path; path = path.replace(/(\.\w+|\[\d+\]|^\w+)$/, "")) {
    const found = form.querySelector(`[data-path="${CSS.escape(path)}"]:not([type="range"])`) ?? form.querySelector(`[data-group="${CSS.escape(path)}"]`);
    if (found) return found;
  }
  return null;
}
