// The page as a whole: what the person describes, its runs, and who draws them.
import { request } from "./api.js";
import * as curves from "./curves.js";
import { by, el, toast } from "./dom.js";
import * as energy from "./energy.js";
import * as events from "./events.js";
import * as files from "./files.js";
import * as form from "./form.js";
import * as link from "./link.js";
import { Slot, times } from "./live.js";
import { read, written } from "./paths.js";
import * as peaks from "./peaks.js";
import * as section from "./section.js";
import * as studies from "./studies.js";
import * as tabs from "./tabs.js";
import { show } from "./units.js";
import * as wave from "./wave.js";

const page = { world: null, system: null, resolution: null, problem: null, runs: {}, quantity: "stress", which: "ends", past: [], reachable: true, metrics: [] };

const slots = {
  current: new Slot("current", { show: (result) => take("current", result), problem: refuse, fail, progress }),
  bare: new Slot("bare", { show: (result) => take("bare", result), problem: () => drop("bare"), fail: () => drop("bare") }),
  pinned: new Slot("pinned", { show: (result) => take("pinned", result), problem: () => drop("pinned"), fail: () => {} }),
};

// ---- what is asked

const isBare = (system) => !system.control && (!system.absorbers || (Array.isArray(system.absorbers) ? !system.absorbers.length : !system.absorbers.count));
const bareOf = (system) => ({ ...system, absorbers: [], control: null });

function preview() {
  const { duration, modes, refinement } = page.resolution, coarse = page.world.resolutions.preview;
  return { duration, time_step: Math.max(page.resolution.time_step, coarse.time_step, Math.ceil((1e3 * duration) / 2500) / 1e3), modes: Math.min(modes, coarse.modes), refinement };
}

function solve(since = performance.now()) {
  const how = { resolution: preview(), full: page.resolution, since };
  slots.current.want(page.system, how);
  if (isBare(page.system)) { slots.bare.stopFull(); drop("bare"); page.bareKey = ""; return; }
  const bare = bareOf(page.system), key = JSON.stringify([{ ...bare, name: "" }, page.resolution]);
  if (key === page.bareKey && page.runs.bare) return;
  page.bareKey = key;
  slots.bare.want(bare, how);
}

function again() {
  page.bareKey = "";
  if (page.runs.pinned) slots.pinned.want(page.runs.pinned.system, { resolution: preview(), full: page.resolution });
  if (page.system) solve();
}

// ---- what the person changes

let lastPath = "", lastTime = 0;
function remember(path, live) {
  const coalesced = live && path === lastPath && performance.now() - lastTime < 1500;
  lastPath = path;
  lastTime = performance.now();
  if (!coalesced) page.past.push(structuredClone({ system: page.system, resolution: page.resolution }));
  if (page.past.length > 100) page.past.shift();
  by("undo").disabled = !page.past.length;
}

let checking = 0;
async function change(path, value, { live = false } = {}) {
  const since = performance.now();
  remember(path, live);
  if (path.startsWith("resolution.")) return resolve(path.slice(11), value);
  page.system = path === "shells" ? withShells(page.system, value) : written(page.system, path, value);
  if (live) {
    page.problem = null;
    form.mark(null);
    form.refresh(forForm());
    section.draw(page.system);
    solve(since);
    return keepLink();
  }
  const mine = ++checking;
  let answer;
  try {
    answer = await request("/api/validate", { body: { system: page.system } });
  } catch (error) { return fail(error); }
  if (mine !== checking) return;
  if (!answer.ok) { // what was typed stays as it was typed, the reason beside it
    if (typeof value === "object" || !read(page.system, path)) form.render(forForm(), answer.problem);
    return refuse(answer.problem);
  }
  page.metrics = answer.metrics ?? [];
  adopt(answer.system, { since, keepForm: typeof value !== "object" && shape(answer.system) === page.shape });
}

// Fluids follow the number of shells, a further gap as the last one; a single shell has no absorbers.
function withShells(system, shells) {
  const fluids = [...system.fluids];
  while (fluids.length < shells.length + 1) fluids.splice(-1, 0, structuredClone(fluids.at(-2)));
  while (fluids.length > shells.length + 1 && fluids.length > 2) fluids.splice(-2, 1);
  return { ...system, shells, fluids, absorbers: shells.length < 2 ? [] : system.absorbers };
}

function resolve(name, value) {
  page.resolution = { ...page.resolution, [name]: value };
  form.mark(null);
  solve();
  again();
  keepLink();
}

const shape = (system) => JSON.stringify(system, (_, value) => (typeof value === "number" ? 0 : value));
const forForm = () => ({ ...page.system, resolution: page.resolution });

// A system that the library has accepted: into the form, the drawing, the solver, the address.
function adopt(system, { since, keepForm = false } = {}) {
  page.system = system;
  page.problem = null;
  page.shape = shape(system);
  by("form").dataset.fluids = system.fluids.length;
  if (keepForm) { form.mark(null); form.refresh(forForm()); } else form.render(forForm(), null);
  section.draw(system);
  solve(since);
  keepLink();
}

// A system described somewhere else: by a preset, in a file, in a link.
async function open(body, path = "/api/validate") {
  try {
    const answer = await request(path, { body });
    if (answer.ok) return opened(answer);
    toast(`Not opened. ${[answer.problem.where, answer.problem.problem, answer.problem.remedy].filter(Boolean).join(": ")}`);
  } catch (error) { toast(`Not opened. ${error.message}`); }
  return null;
}

function opened(answer) {
  if (page.system) remember("", false);
  if (answer.resolution) page.resolution = { ...page.world.resolutions.full, ...answer.resolution };
  const view = answer.view ?? {};
  if (view.quantity) page.quantity = view.quantity;
  if (view.tab && document.getElementById(`tab-${view.tab}`)) tabs.choose(view.tab);
  page.metrics = answer.metrics ?? page.metrics;
  adopt(answer.system);
  return answer;
}

let linkTimer;
const content = () => ({ system: page.system, resolution: page.resolution, view: { quantity: page.quantity, tab: tabs.shown() } });
function keepLink() {
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => link.put(content()), 400);
}

// ---- what comes back

function take(slot, result) {
  page.runs[slot] = result;
  if (slot === "current") { page.problem = null; by("response").classList.remove("stale"); }
  drawRuns();
}

function drop(slot) {
  if (!page.runs[slot]) return;
  delete page.runs[slot];
  drawRuns();
}

function refuse(problem) {
  page.problem = problem;
  const mended = /^(duration|time_step|modes|refinement)/.test(problem.where) ? { ...problem, where: `resolution.${problem.where}` } : problem;
  slots.current.stopFull();
  form.mark(mended);
  by("response").classList.add("stale");
  say();
}

function fail(error) {
  page.problem = { where: error.where ?? "", problem: error.problem ?? error.message, remedy: error.remedy ?? "" };
  say();
}

function progress(job) {
  page.job = job;
  by("progress").hidden = !job;
  if (job) by("progress").querySelector("progress").value = job.fraction;
  say();
}

let drawing = 0;
function drawRuns() {
  cancelAnimationFrame(drawing);
  drawing = requestAnimationFrame(() => {
    quantities();
    shellsShown();
    curves.legend(page.runs);
    curves.draw(page.runs, quantityShown(), whichShells());
    drawTab(tabs.shown());
    by("pin").textContent = page.runs.pinned ? "Unpin" : "Pin";
    by("pin").disabled = !page.runs.current;
    say();
    document.documentElement.dataset.revision = page.runs.current?.revision ?? 0;
  });
}

let tabTimer;
function drawTab(name) {
  clearTimeout(tabTimer); // energy and field take a moment: wait until a slider rests
  if (name === "peaks") peaks.draw(page.runs);
  if (name === "studies") studies.offer();
  if (!page.runs.current) return;
  if (name === "energy") tabTimer = setTimeout(() => energy.draw(page.runs.current.run, Math.ceil(page.runs.current.arrays.time.values.length / 200)), 300);
  if (name === "wave") tabTimer = setTimeout(() => wave.load(page.runs), 300);
  if (name !== "wave") { wave.pause(); curves.cursor(null); } else wave.draw();
}

const quantityShown = () => all().find((one) => one.name === page.quantity) ?? all()[0];

function all() {
  const arrays = Object.values(page.runs).flatMap((run) => Object.keys(run.arrays));
  const known = page.world.quantities.some((one) => one.name === "absorber_force") ? page.world.quantities : [...page.world.quantities, { name: "absorber_force", label: "absorber force", unit: "N/m" }];
  return known.filter((one) => arrays.some((name) => name.startsWith(`${one.name}/`)));
}

function quantities() {
  const select = by("quantity"), wanted = all().map((one) => el("option", { value: one.name, selected: one.name === quantityShown()?.name }, one.label.replace(/^./, (c) => c.toUpperCase())));
  if (select.textContent !== wanted.map((one) => one.textContent).join("") || select.value !== quantityShown()?.name) select.replaceChildren(...wanted);
}

function whichShells() {
  const count = page.runs.current?.shells.length ?? page.runs.bare?.shells.length ?? 1;
  if (page.which !== "ends" && Number(page.which) < count) return [Number(page.which)];
  return count > 1 ? [0, count - 1] : [0];
}

function shellsShown() {
  const shells = page.runs.current?.shells ?? [];
  by("which-shells").hidden = shells.length < 3;
  const select = by("shells"), wanted = [el("option", { value: "ends" }, "Innermost and outermost"), ...shells.map((shell) => el("option", { value: shell.index }, `Shell ${shell.name}`))];
  if (select.children.length !== wanted.length) select.replaceChildren(...wanted);
}

function say() {
  const { current } = page.runs, box = by("state");
  by("refine").hidden = Boolean(page.job) || !current || current.full || Boolean(page.problem);
  if (!page.reachable) box.textContent = "The server does not answer; trying again. Is coaxshell studio still running?";
  else if (page.problem) box.textContent = `Not solved: ${[page.problem.where, page.problem.problem].filter(Boolean).join(": ")}`;
  else if (!current) box.textContent = "Solving…";
  else {
    const { modes, time_step } = current.resolution;
    const how = `${modes} orders, step ${show(time_step, "")} a/c${current.seconds > 0.002 ? `, ${show(current.seconds, "s", 2)}` : ""}`; // less: it was there
    box.textContent = page.job ? `Preview (${how}); full resolution: ${Math.round(100 * page.job.fraction)}\u202f% ${page.job.stage ?? ""}` : `${current.full ? "Full resolution" : "Preview"} (${how})`;
  }
}

// ---- setting up

function wire() {
  by("preset").addEventListener("change", (event) => open({ system: page.world.presets[event.target.value].system }));
  by("quantity").addEventListener("change", (event) => { page.quantity = event.target.value; drawRuns(); keepLink(); });
  by("shells").addEventListener("change", (event) => { page.which = event.target.value; drawRuns(); });
  by("undo").addEventListener("click", () => {
    const { system, resolution } = page.past.pop();
    by("undo").disabled = !page.past.length;
    lastPath = "";
    page.resolution = resolution;
    adopt(system);
  });
  by("pin").addEventListener("click", () => {
    if (page.runs.pinned) { slots.pinned.stopFull(); return drop("pinned"); }
    const { system } = page.runs.current;
    take("pinned", page.runs.current);
    slots.pinned.want(system, { resolution: preview(), full: page.resolution });
  });
  by("cancel").addEventListener("click", () => slots.current.stopFull());
  by("refine").addEventListener("click", () => slots.current.refine());
  by("form").addEventListener("submit", (event) => event.preventDefault());
  document.addEventListener("theme", () => { energy.forget(); if (page.runs.current) drawRuns(); });
  tabs.onTab((name) => { drawTab(name); if (name === "studies") studies.fit(); if (page.system) keepLink(); });
  addEventListener("hashchange", () => link.held() && open({ fragment: link.held() }, "/api/link/open"));
  files.setUp({ runs: () => page.runs, opened, described: content, films: () => page.world.films });
  studies.setUp(() => page, { preview, opened });
  wave.setUp(curves.cursor);
  curves.onTime((time) => { wave.pause(); wave.seek(time); });
  events.onRestart(() => { wave.forget(); energy.forget(); again(); });
  events.onConnection((reachable) => { page.reachable = reachable; if (page.world) say(); });
  addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === "z" && !event.target.matches("input[type=text], textarea") && page.past.length) { event.preventDefault(); by("undo").click(); }
  });
}

async function begin() {
  try {
    page.world = await request("/api/schema");
  } catch (error) {
    by("state").textContent = `${error.problem ?? error.message}; trying again`;
    return setTimeout(begin, 1000);
  }
  page.resolution = { ...page.world.resolutions.full };
  form.setUp(page.world, change);
  by("preset").replaceChildren(...page.world.presets.map((one, i) => el("option", { value: i, title: one.title }, one.name)));
  events.listen();
  wire();
  const first = page.world.presets.findIndex((one) => one.name === "hybrid");
  by("preset").value = first;
  const fragment = link.held();
  if (!fragment || !(await open({ fragment }, "/api/link/open"))) await open({ system: page.world.presets[first].system });
}

// For the tests: how long the last changes took until their curves were drawn.
Object.defineProperty(window, "coaxshell", { value: { state: page, times } });
begin();
