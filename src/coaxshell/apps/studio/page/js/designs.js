// Named designs: kept, solved one after another, compared in one table and on one plot with what differs marked; a project file holds them.
import { client, request } from "./api.js";
import { row } from "./arrays.js";
import { SETTINGS, UNITS, above, frame } from "./curves.js";
import { differences, setUp as readUnits } from "./differences.js";
import { by, el, saveText, toast } from "./dom.js";
import { finished } from "./events.js";
import { spatial } from "./space.js";
import { colour } from "./theme.js";
import { inComparison, percent, prefixed, show } from "./units.js";
import { capital, shellName, told } from "./words.js";

const KEPT = "coaxshell-designs", HUES = 7, DASHES = ["solid", "dash", "dot"], MOST_ROWS = 60;
const parts = {};
let designs = [], world = {}, busy = false, work = null, inFull = false, reference = 0, quantity = "stress", place = "", revision = 0;

// `page` gives what main.js holds; `previewOf` a coarse resolution; `open` puts a description into the form; `kept` is told of every change.
export function setUp(page, { previewOf, open, unit, kept }) {
  world = { page, previewOf, open, unit, kept };
  readUnits(page().world.schema);
  const button = (text, onclick, more = {}) => el("button", { type: "button", onclick, ...more }, text);
  Object.assign(parts, {
    name: el("input", { type: "text", id: "design-name", size: 24, maxlength: 60, autocomplete: "off", spellcheck: "false" }),
    file: el("input", { type: "file", accept: ".toml", hidden: true, "aria-label": "A project file", onchange: async () => { const [file] = parts.file.files; parts.file.value = ""; if (file) openText(await file.text()); } }),
    save: button("Save project", save), full: button("Full resolution", () => { if (work) { work.cancel(); inFull = false; } else { inFull = true; solveAll(); } draw(); }, { id: "designs-full" }),
    state: el("p", { class: "note", role: "status", id: "designs-state" }), list: el("ul", { class: "design-list" }), table: el("div"), figure: el("div"), differing: el("div"),
    quantity: el("select", { id: "designs-quantity", onchange: () => { quantity = parts.quantity.value; chart(); } }), place: el("select", { id: "designs-place", onchange: () => { place = parts.place.value; chart(); } }),
    reference: el("select", { id: "designs-reference", onchange: () => { reference = Number(parts.reference.value); draw(); } }),
    plot: el("div", { id: "designs-plot", class: "study-plot" }),
  });
  const labelled = (text, input) => el("label", {}, el("span", {}, text), input);
  const form = el("form", { class: "study", autocomplete: "off", onsubmit: (event) => { event.preventDefault(); keep(); } },
    el("div", { class: "row" }, labelled("Name", parts.name), el("button", { class: "main", type: "submit" }, "Keep this design"), button("Open project…", () => parts.file.click()), parts.save, parts.full, parts.file));
  parts.figure.append(el("div", { class: "study" }, el("div", { class: "row" }, labelled("Quantity", parts.quantity), labelled("Where", parts.place))), parts.plot);
  by("designs").replaceChildren(form, parts.state, parts.list, el("div", { class: "study", id: "designs-against" }, labelled("Compared with", parts.reference)), parts.differing, parts.figure, parts.table);
  try { designs = JSON.parse(sessionStorage.getItem(KEPT)) ?? []; } catch { designs = []; }
  document.addEventListener("theme", () => { if (parts.plot.data) chart(); });
}

export const count = () => designs.length;
export const isProject = (text) => /^\s*\[\[designs\]\]/m.test(text);
export function forget() { for (const one of designs) one.run = null; if (shownNow()) draw(); }
const shownNow = () => !by("designs").hidden;
const label = ({ name }) => name;

function keep() {
  const { system, resolution, problems, world: { limits } } = world.page(), name = parts.name.value.trim() || freeName(system.name || "design");
  if (problems.length) return toast("Not kept: what the form holds cannot be solved as it is.");
  const number = designs.findIndex((one) => one.name === name);
  if (number < 0 && designs.length >= limits.designs) return toast(`At most ${limits.designs} designs: remove one first.`);
  const one = { name, system: structuredClone(system), resolution: structuredClone(resolution) };
  if (number < 0) designs.push(one); else designs[number] = one;
  parts.name.value = "";
  toast(number < 0 ? `Kept as ${name}.` : `${name} is now what the form holds.`);
  return changed();
}

function freeName(base) {
  const names = new Set(designs.map(label));
  for (let i = 1; ; i += 1) { const name = i === 1 ? base : `${base} (${i})`; if (!names.has(name)) return name; }
}

function changed() {
  try { sessionStorage.setItem(KEPT, JSON.stringify(designs.map(({ name, system, resolution }) => ({ name, system, resolution })))); } catch { /* too large to be kept over a reload */ }
  draw();
  world.kept();
}

// ---- the project file

async function save() {
  try {
    const answer = await request("/api/project", { body: { designs: designs.map(({ name, system, resolution }) => ({ name, system, resolution: given(resolution) })) } });
    if (!answer.ok) return toast(`Not saved. ${told(answer.problem)}`);
    saveText(answer.toml, "coaxshell-project.toml");
  } catch (failure) { toast(`Not saved. ${told(failure)}`); }
  return null;
}

export async function openText(toml) {
  try {
    const answer = await request("/api/project/open", { body: { toml } });
    if (!answer.ok) return toast(`Not opened. ${told(answer.problem)}`);
    const room = world.page().world.limits.designs - designs.length, some = answer.designs.slice(0, room);
    for (const one of some) designs.push({ ...one, name: freeName(one.name) });
    toast(some.length < answer.designs.length ? `Only ${some.length} of ${answer.designs.length} designs opened: there is no room for more.` : `${some.length} design${some.length === 1 ? "" : "s"} opened.`);
    return changed();
  } catch (failure) { return toast(`Not opened. ${told(failure)}`); }
}

// ---- solving them, one after another

const next = () => designs.find((one) => !one.problem && (!one.run || (inFull && !one.full)));

async function solveAll() {
  if (busy) return;
  busy = true;
  for (let one = next(); one && shownNow(); one = next()) {
    await solve(one, Boolean(one.run));
    draw(false);
  }
  busy = false;
  inFull &&= Boolean(next());
  draw(false);
}

async function solve(one, full) {
  const { system, resolution } = one, coarse = full ? resolution : world.previewOf(resolution);
  say(`Solving ${one.name}${full ? " at full resolution" : ""}…`);
  try {
    if (!full && !spatial(resolution)) {
      const answer = await request("/api/solve", { body: { client, slot: "design", revision: ++revision, system, resolution: coarse, histories: "without rates" } });
      if (answer?.ok) { one.run = answer; return; }
      if (answer && answer.problem.where !== "resolution") { one.problem = told(answer.problem); return; }
    }
    const body = { kind: "solve", slot: "design-full", revision: ++revision, system, resolution: given(full || !spatial(resolution) ? resolution : coarse) };
    const mine = (work = finished(body, (job) => say(`Solving ${one.name}: ${Math.round(100 * (job.fraction ?? 0))}\u202f% ${job.stage ?? ""}`)));
    draw(false);
    const job = await mine.promise;
    one.run = await request(`/api/runs/${job.run}`);
    one.full = full || !spatial(resolution);
  } catch (failure) {
    if (failure.cancelled) inFull = false;
    if (!failure.cancelled || !one.run) one.problem = failure.cancelled ? "cancelled" : told(failure);
  } finally { work = null; say(""); }
}

const given = (resolution) => Object.fromEntries(Object.entries(resolution).filter(([, value]) => value !== null && value !== undefined));
const say = (text) => { parts.state.textContent = text; };

// ---- what is shown

export function draw(start = true) {
  const some = designs.length > 0, solved = designs.filter((one) => one.run);
  parts.name.placeholder = freeName(world.page().system?.name || "design");
  parts.save.disabled = !some;
  parts.full.disabled = !work && (!some || designs.every((one) => one.full || one.problem));
  parts.full.textContent = work ? "Cancel" : "Full resolution";
  reference = Math.min(reference, Math.max(designs.length - 1, 0));
  const lines = designs.map(line);
  if (!parts.list.contains(document.activeElement) || parts.list.children.length !== lines.length) parts.list.replaceChildren(...lines);
  fill(parts.reference, designs.map(({ name }, i) => [i, name]), reference);
  by("designs-against").hidden = designs.length < 2;
  parts.table.replaceChildren(...(some ? (solved.length ? [comparison(solved)] : []) : [el("p", { class: "empty" }, "No design is kept yet. Keep what the form holds under a name, change it, keep it again: all are compared here, and a project file takes them home.")]));
  parts.figure.hidden = !solved.length;
  parts.differing.replaceChildren(...(designs.length > 1 ? [differing()] : []));
  if (solved.length) chart();
  if (start && shownNow() && next()) solveAll();
}

function line(one, i) {
  const act = (text, what, words) => el("button", { type: "button", class: "quiet", "aria-label": `${words} ${one.name}`, onclick: what }, text);
  return el("li", {}, el("i", { class: "swatch", style: `border-top: 3px ${DASHES[Math.floor(i / HUES) % 3].replace("dash", "dashed").replace("dot", "dotted")} var(--series-${i % HUES})` }),
    el("input", { type: "text", value: one.name, maxlength: 60, "aria-label": `Name of ${one.name}`, onchange: (event) => { const name = event.target.value.trim(); one.name = name && designs.every((other) => other === one || other.name !== name) ? name : one.name; changed(); } }),
    el("span", { class: "note" }, one.problem ?? (one.run ? `${spatial(one.resolution) ? "three dimensions, " : ""}${one.run.resolution.modes} orders, step ${show(one.run.resolution.time_step, "")} a/c${one.full ? "" : " (preview)"}` : "not solved yet")),
    act("Put into the form", () => world.open({ system: one.system, resolution: given(one.resolution) }, one.name), "Put into the form:"),
    act("Remove", () => { designs.splice(i, 1); changed(); }, "Remove"));
}

function fill(select, options, chosen) {
  const text = JSON.stringify(options);
  if (select.dataset.options !== text) { select.replaceChildren(...options.map(([value, words]) => el("option", { value }, words))); select.dataset.options = text; }
  select.value = chosen;
}

// Bars by name and shell: the inner ones beside the inner ones, however many there are between.
const bars = ({ run }) => new Map(run.bars.map((bar) => [`${bar.shell === null || bar.shell === undefined ? "" : shellName(bar.shell, run.shells.length)}/${bar.name}`, bar]));

function comparison(solved) {
  const each = solved.map(bars), first = Math.max(0, solved.indexOf(designs[reference])), keys = [...new Set(each.flatMap((one) => [...one.keys()]))];
  const names = [...new Set(keys.map((key) => key.split("/")[0]))].sort((a, b) => order(a) - order(b));
  const table = el("table", { class: "peaks designs" }, el("caption", {}, solved.length > 1 ? `Largest magnitudes; the change is against “${solved[first].name}”, the least of each row stands bold` : "Largest magnitudes: keep another design to compare it"),
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Quantity"), ...solved.map(({ name }) => el("th", { scope: "col", class: "number" }, name)))),
    ...names.map((name) => el("tbody", {}, el("tr", {}, el("th", { scope: "rowgroup", colspan: 1 + solved.length }, name ? capital(name.includes("shell") ? name : `${name} shell`) : "Absorbers")),
      ...keys.filter((key) => key.split("/")[0] === name).map((key) => {
        const found = each.map((one) => one.get(key)), values = found.map((bar) => bar?.value ?? null), least = Math.min(...values.filter((value) => value !== null));
        const { label: words } = found.find(Boolean);
        return el("tr", {}, el("th", { scope: "row" }, words), ...found.map((bar, i) => cell(bar, found[first], i === first, solved.length > 1 && bar?.value === least)));
      }))));
  return el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "Designs compared" }, table);
}

const order = (name) => (name === "" ? 3 : name === "inner" || name === "shell" ? 0 : name === "outer" ? 2 : 1);

function cell(bar, against, same, least) {
  if (!bar) return el("td", { class: "number" }, "–");
  const grows = bar.growing || against?.growing, change = same || !against || grows ? null : percent(bar.value, against.value);
  const kind = change === null || Math.abs(change) < 0.05 ? "" : change < 0 ? "better" : "worse";
  return el("td", { class: "number" }, el("span", { class: least && !bar.growing ? "most" : "" }, show(bar.value, bar.unit)), same || !against ? null : el("small", { class: kind }, grows ? "still growing" : inComparison(change)));
}

function differing() {
  const rows = differences(designs), some = rows.slice(0, MOST_ROWS);
  if (!rows.length) return el("p", { class: "note" }, "The designs do not differ in anything but their names.");
  return el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "What differs" }, el("table", { class: "peaks designs" },
    el("caption", {}, `Entries that differ${rows.length > some.length ? `: the first ${some.length} of ${rows.length}` : ""}; what is not as in “${designs[reference].name}” is marked`),
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Entry"), ...designs.map(({ name }) => el("th", { scope: "col", class: "number" }, name)))),
    el("tbody", {}, ...some.map(({ path, label: words, values }) => el("tr", {}, el("th", { scope: "row", title: path }, capital(words)), ...values.map((value) => el("td", { class: `number${value === values[reference] ? "" : " differs"}` }, value || "–")))))));
}

// ---- the plot

function chart() {
  const solved = designs.filter((one) => one.run), each = world.page().world.quantities.filter((one) => !one.rate && solved.some(({ run }) => Object.keys(run.arrays).some((name) => name.startsWith(`${one.name}/`))));
  if (!each.some(({ name }) => name === quantity)) quantity = each[0]?.name ?? "";
  fill(parts.quantity, each.map(({ name, label: words }) => [name, capital(words)]), quantity);
  const places = [...new Set(solved.flatMap(({ run }) => run.shells.map(({ index }) => shellName(index, run.shells.length))))].sort((a, b) => order(a) - order(b)).flatMap((name) => ["head", "tail"].map((end) => [`${name}/${end}`, `${capital(name)}, ${end}`]));
  if (!places.some(([value]) => value === place)) [[place]] = places;
  fill(parts.place, places, place);
  if (!window.Plotly) return;
  const [name, end] = place.split("/"), found = solved.map((one) => ({ one, ...history(one.run, name, end === "tail" ? 1 : 0) })).filter(({ values }) => values);
  let largest = 0;
  for (const { values } of found) for (const value of values) largest = Math.max(largest, Math.abs(value));
  const { label: words, unit } = each.find((one) => one.name === quantity) ?? { label: "", unit: "" }, scale = prefixed(unit, largest), time = UNITS[world.unit()];
  const { style, axis, layout } = frame({ height: 340, showlegend: true, hovermode: "x" });
  Object.assign(layout, { legend: above(style), margin: { l: 68, r: 12, t: 12, b: 40 }, uirevision: `${quantity}${place}${world.unit()}`,
    xaxis: { ...axis, title: { text: `time (${time.name})`, font: style, standoff: 4 } }, yaxis: { ...axis, title: { text: `${words} (${scale.unit})`, font: style } } });
  const traces = found.map(({ one, values, times }) => {
    const i = designs.indexOf(one);
    return { type: "scatter", mode: "lines", name: one.name, x: Float32Array.from(times, (value) => value * time.of(one.run)), y: Float32Array.from(values, (value) => value / scale.factor),
      line: { color: colour(`series-${i % HUES}`), dash: DASHES[Math.floor(i / HUES) % 3], width: 1.6, simplify: false }, hovertemplate: `%{y:.4~g} ${scale.unit}` };
  });
  window.Plotly.react(parts.plot, traces, layout, SETTINGS);
  parts.plot.setAttribute("role", "img");
  parts.plot.setAttribute("aria-label", `${words} against time, ${place.replace("/", ", ")}: ${found.map(({ one, values }) => `${one.name} up to ${show(values.reduce((most, value) => Math.max(most, Math.abs(value)), 0), unit)}`).join("; ")}`);
}

function history(run, name, end) {
  const index = run.shells.findIndex((shell) => shellName(shell.index, run.shells.length) === name), array = run.arrays[`${quantity}/${index}`];
  if (!array) return {};
  return { times: run.arrays.time.values, values: row(array, array.shape.length < 3 ? Math.min(end, array.shape[0] - 1) : end) };
}
