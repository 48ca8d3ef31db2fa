// The page as a whole: what the person describes, its runs, and who draws them.
import { request } from "./api.js";
import * as building from "./building.js";
import * as curves from "./curves.js";
import * as designs from "./designs.js";
import { by, el, instead, toast } from "./dom.js";
import * as energy from "./energy.js";
import * as events from "./events.js";
import * as files from "./files.js";
import * as form from "./form.js";
import * as guide from "./guide.js";
import * as handles from "./handles.js";
import * as link from "./link.js";
import * as loops from "./loops.js";
import { Slot, drawn, sent, times } from "./live.js";
import * as past from "./past.js";
import { read, written } from "./paths.js";
import * as peaks from "./peaks.js";
import * as record from "./record.js";
import * as section from "./section.js";
import * as space from "./space.js";
import * as spectra from "./spectra.js";
import * as stressed from "./stressed.js";
import * as studies from "./studies.js";
import * as tabs from "./tabs.js";
import { show } from "./units.js";
import * as wall from "./wall.js";
import * as wave from "./wave.js";
import { capital, inWords, placeName, refusal, shellName, told } from "./words.js";

const page = { world: null, system: null, resolution: null, problems: [], runs: {}, quantity: "stress", which: "ends", unit: "transits", reachable: true, metrics: [], jobs: {}, station: null };

const PANELS = [stressed, spectra, loops];
const slots = {
  current: new Slot("current", { show: (result) => take("current", result), measured, judged: () => peaks.drawJudgement(page.runs.current), problem: (problems) => refuse(problems), fail, progress: (job) => progress("current", job) }),
  // A refusal of these is the current one's too, told there; what they showed last stays beside what it showed last.
  bare: new Slot("bare", { show: (result) => take("bare", result), measured, problem: () => {}, fail: () => { page.bareKey = ""; }, progress: (job) => progress("bare", job) }),
  pinned: new Slot("pinned", { show: (result) => take("pinned", result), measured, problem: () => drop("pinned"), fail: () => {} }),
};

// ---- what is asked

const isBare = (system) => !system.control && (!system.absorbers || (Array.isArray(system.absorbers) ? !system.absorbers.length : !system.absorbers.count));
const bareOf = (system) => ({ ...system, absorbers: [], control: null });

// A coarse resolution within the limits of what is solved at once, whatever was typed: those of full resolution are what a person is told.
function previewOf(resolution) {
  const { duration, time_step, modes, refinement } = resolution, most = page.world.limits.preview_steps, around = space.spatial(resolution);
  const coarse = page.world.resolutions[around ? "preview_spatial" : "preview"];
  const step = Math.max(time_step, coarse.time_step, Math.ceil((1e3 * duration) / most) / 1e3);
  const plane = { duration, time_step: step, modes: Math.min(modes, coarse.modes), refinement: Math.max(1, Math.min(refinement, Math.floor((most * step) / duration))) };
  return around ? { ...plane, ...space.ofSpace(resolution, plane) } : plane;
}

const preview = () => previewOf(page.resolution);

const inSpace = () => space.spatial(page.resolution);

function solve(since = performance.now(), moving = false) {
  const how = { resolution: preview(), full: page.resolution, since, moving };
  page.stopped = false;
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

const state = () => ({ system: page.system, resolution: page.resolution, from: page.from });

function goTo(found) {
  if (!found) return;
  page.resolution = found.resolution;
  startedFrom(found.from);
  if (page.runs.pinned) slots.pinned.want(page.runs.pinned.system, { resolution: preview(), full: page.resolution });
  check({ keepForm: false });
}

let checking = 0;
async function change(path, value, { live = false } = {}) {
  const since = performance.now(), ofResolution = path.startsWith("resolution.");
  past.keep(state(), path, live);
  if (path === "resolution.dimensions") page.resolution = space.inDimensions(page.resolution, value, page.world.resolutions);
  else if (ofResolution) page.resolution = { ...page.resolution, [path.slice(11)]: value };
  else page.system = written(page.system, path, value);
  if (live && !page.problems.length) {
    solve(since, true); // the server is at it while the page is brought up to date
    form.refresh(forForm());
    section.draw(page.system);
    return keepLink();
  }
  const whole = typeof value === "object" || value === undefined || path === "resolution.dimensions" || (!ofResolution && !read(page.system, path));
  return check({ since, path, whole, keepForm: !whole });
}

// ---- absorbers taken hold of on the section

function addAbsorber() {
  const { absorbers } = page.system, most = page.world.limits.absorbers, like = absorbers[numberOf(handles.choice())] ?? absorbers.at(-1) ?? form.newAbsorber();
  if (absorbers.length >= most) return toast(`At most ${most} absorbers.`);
  handles.expect(`absorbers[${absorbers.length}]`);
  return change("absorbers", [...absorbers, { ...like, angle: building.freeAngle(absorbers, like) }]);
}

function removeAbsorber(key) {
  const { absorbers } = page.system, number = numberOf(key);
  if (!key.startsWith("absorbers")) return null;
  if (Array.isArray(absorbers)) handles.expect(`absorbers[${Math.min(number, absorbers.length - 2)}]`);
  return change("absorbers", Array.isArray(absorbers) ? absorbers.filter((_, i) => i !== number) : []);
}

const numberOf = (key) => (key.startsWith("absorbers[") ? Number(key.slice(10, -1)) : -1);
const placeSingly = () => change("absorbers", building.singly(page.system.absorbers));

// Ask the library about system and resolution: adopted when it accepts both, else every problem beside its field, that of `path` first.
async function check({ since, path = "", whole = false, keepForm }) {
  const mine = ++checking;
  let answer;
  try {
    answer = await request("/api/validate", { body: asked() });
  } catch (error) { return fail(error); }
  if (mine !== checking) return;
  if (!answer.ok) { // what was typed stays as it was typed, the reason beside it
    if (whole || !keepForm) form.render(forForm(), []);
    return refuse(answer.problems, path);
  }
  understood(answer);
  page.resolution = { ...page.resolution, ...answer.resolution };
  const finer = JSON.stringify(page.resolution) !== page.resolved;
  page.resolved = JSON.stringify(page.resolution);
  adopt(answer.system, { since, keepForm: keepForm && shape(answer.system) === page.shape });
  if (finer && page.runs.pinned) slots.pinned.want(page.runs.pinned.system, { resolution: preview(), full: page.resolution });
}

const shape = (system) => JSON.stringify(system, (_, value) => (typeof value === "number" ? 0 : value));
const forForm = () => ({ ...page.system, resolution: page.resolution, costs: page.costs });

const asked = () => ({ system: page.system, resolution: given(page.resolution), choices: true, ...(inSpace() ? { preview: preview() } : {}) });

// What the system takes as it is, and with other choices, stands in the form as soon as it is known.
async function tellCosts() {
  const of = page.system, answer = await request("/api/validate", { body: asked() }).catch(() => null);
  if (!answer?.ok || of !== page.system) return;
  page.costs = answer.costs;
  form.refresh(forForm());
}

// What is left open is the library's to choose.
const given = (resolution) => Object.fromEntries(Object.entries(resolution).filter(([, value]) => value !== null));

function understood(answer) {
  page.metrics = answer.metrics ?? page.metrics;
  page.costs = answer.costs ?? null;
  Object.assign(page.world.metric_units, answer.metric_units);
  record.understood(answer.records);
}

// A system that the library has accepted: into the form, the drawing, the solver, the address.
function adopt(system, { since, keepForm = false } = {}) {
  page.system = system;
  page.problems = [];
  page.shape = shape(system);
  if (keepForm) { form.mark([]); form.refresh(forForm()); } else form.render(forForm(), []);
  section.draw(system);
  solve(since);
  keepLink();
}

// A system described somewhere else: by a preset, in a file, in a link. The last one asked for is opened, whichever comes back first.
let opening = 0;
async function open(body, from, path = "/api/validate") {
  const mine = (opening += 1);
  let problem;
  try {
    const answer = await request(path, { body });
    if (mine !== opening) return true;
    if (answer.ok) return Boolean(opened(answer, from));
    problem = answer.problem;
  } catch (error) { problem = error; }
  if (mine === opening) toast(`Not opened. ${told(problem)}`);
  return mine !== opening;
}

// The list of presets shows what the system was made from; choosing that one again starts anew.
function startedFrom(name) {
  page.from = name;
  const select = by("preset"), own = select.options[select.options.length - 1];
  own.textContent = name;
  own.title = page.world.presets.find((one) => one.name === name)?.title ?? "";
  own.selected = true;
}

function opened(answer, from) {
  if (page.system) past.keep(state(), "", false);
  checking += 1;
  startedFrom(typeof answer.view?.from === "string" ? answer.view.from.slice(0, 60) : from);
  if (answer.resolution) page.resolution = { ...page.world.resolutions.full, ...answer.resolution };
  else if (space.needsSpace(answer.system)) page.resolution = space.inDimensions(page.resolution, 3, page.world.resolutions);
  page.resolved = JSON.stringify(page.resolution);
  const view = answer.view ?? {};
  if (view.quantity) choose(view.quantity);
  if (view.unit in curves.UNITS) page.unit = by("unit").value = view.unit;
  if (typeof view.station === "number") page.station = view.station;
  if (view.tab && document.getElementById(`tab-${view.tab}`)) tabs.choose(view.tab);
  understood(answer);
  if (!inSpace()) { adopt(answer.system); tellCosts(); }
  else { page.system = answer.system; check({ keepForm: false }); } // what it costs is told with its resolution alone
  return answer;
}

let linkTimer;
const content = () => ({ system: page.system, resolution: page.resolution, view: { quantity: page.quantity, tab: tabs.shown(), unit: page.unit, from: page.from, station: page.station ?? undefined } });
function keepLink() {
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => link.put(content()).catch(() => {}), 400);
}

// ---- what comes back

function take(slot, result) {
  page.runs[slot] = result;
  if (slot === "current") { // an answer to an older wish says nothing about what is in the form now
    if (result.system === page.system && result.revision === slots.current.wanted.revision && !page.problems.length) stale(false);
    if (isBare(result.system)) drop("bare");
  }
  drawRuns();
}

function drop(slot) {
  if (!page.runs[slot]) return;
  delete page.runs[slot];
  drawRuns();
}

// Curves, peaks, warnings, wave and energy of a state that is no longer in the form are dimmed, and a line above says so.
function stale(is, solving = false) {
  document.documentElement.classList.toggle("stale", is);
  for (const note of document.querySelectorAll(".of-old")) {
    note.hidden = !is || !page.runs.current;
    note.textContent = `Of the last description that ${solving ? "was solved: what the form holds now is still being solved." : "could be solved, not of what the form holds now."}`;
  }
}

// The description is refused: everything that is wrong beside its field, that of the field just edited told first.
function refuse(problems, edited = "") {
  const found = problems.map(refusal).map((one) => (/^(duration|time_step|modes|refinement|dimensions|stations|axial_modes|axial_period)/.test(one.where) ? { ...one, where: `resolution.${one.where}` } : one));
  const mine = ({ where }) => edited && (where === edited || where.startsWith(`${edited}.`) || where.startsWith(`${edited}[`));
  page.problems = [...found.filter(mine), ...found.filter((one) => !mine(one))];
  slots.current.stopFull();
  form.mark(page.problems);
  stale(true);
  say();
}

// Anything else that goes wrong; what full resolution alone cannot have leaves the preview as it is.
function fail(error, full = false) {
  page.problems = [{ ...refusal(error), full }];
  if (page.problems[0].where) form.mark(page.problems);
  if (!full) stale(true);
  say();
  if (error.status === 0) later(page.problems);
}

// What the server could not be asked is asked again once it answers.
function later(problems) {
  setTimeout(() => {
    if (page.problems !== problems) return;
    if (!page.reachable) return later(problems);
    page.problems = [];
    again();
  }, 1500);
}

// Of the current system, then of the bare one where it takes as long.
function progress(slot, told) {
  page.jobs[slot] = told && (slot === "current" || inSpace()) ? told : null;
  page.job = page.jobs.current ?? page.jobs.bare;
  const { job } = page;
  by("progress").hidden = !job;
  if (job) by("progress").querySelector("progress").value = job.fraction;
  if (slot === "current" && page.jobs.current && !job.full) stale(true, true);
  say();
}

// Bars come after the curves: those who show any draw them anew.
function measured() {
  if (["peaks", "control"].includes(tabs.shown())) drawTab(tabs.shown());
}

let drawing = 0;
function drawRuns() {
  cancelAnimationFrame(drawing);
  drawing = requestAnimationFrame(() => {
    quantities();
    shellsShown();
    curves.legend(page.runs);
    curves.draw(page.runs, quantityShown(), whichShells(), page.unit, space.stationShown(page.runs.current, page.station));
    drawn(page.runs.current);
    drawTab(tabs.shown());
    guide.look();
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
  if (name === "designs") designs.draw();
  guide.look();
  if (!page.runs.current) return;
  const { current } = page.runs;
  instead(by("wall"), !(current.stations?.length > 1) && "The stress on a wall laid flat, over angle and axial position, is there in three dimensions with several stations: choose them under Dimensions.");
  if (name === "energy") tabTimer = setTimeout(() => energy.draw(current, page.unit), 300);
  if (name === "wave") tabTimer = setTimeout(() => wave.load(page.runs), 300);
  if (name === "wall" && current.stations?.length > 1) tabTimer = setTimeout(() => wall.draw(current, page.unit), 300);
  const panel = { stressed: () => stressed.draw(current), spectra: () => spectra.draw(current, space.stationShown(current, page.station)), control: () => loops.draw(current) }[name];
  if (panel) tabTimer = setTimeout(panel, 300);
  if (name !== "wave") { wave.pause(); curves.cursor(null); } else wave.draw();
}

// Velocities and accelerations are asked for once they are shown.
function choose(quantity) {
  page.quantity = quantity;
  sent.rates = Boolean(page.world.quantities.find((one) => one.name === quantity)?.rate);
  if (sent.rates && Object.values(page.runs).some((run) => run.left_out?.includes(quantity))) again();
}

const quantityShown = () => all().find((one) => one.name === page.quantity) ?? all()[0];

function all() {
  const arrays = Object.values(page.runs).flatMap((run) => [...Object.keys(run.arrays), ...(run.left_out ?? []).map((name) => `${name}/`)]);
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
  const select = by("shells"), wanted = [el("option", { value: "ends" }, "Inner and outer"), ...shells.map((shell) => el("option", { value: shell.index }, capital(shellName(shell.index, shells.length))))];
  if (select.children.length !== wanted.length) { page.which = "ends"; select.replaceChildren(...wanted); }
}

function say() {
  const { current } = page.runs, box = by("state");
  by("refine").hidden = Boolean(page.job) || (!page.stopped && (!current || current.full)) || page.problems.length > 0;
  by("refine").textContent = page.stopped ? "Solve the preview" : `Full resolution${inSpace() && page.costs ? `, about ${page.costs.full.duration.replace(" ", "\u202f")}` : ""}`;
  if (!page.reachable) box.textContent = "The server does not answer; trying again. Is coaxshell studio still running?";
  else if (page.problems.length) {
    const [{ where, problem, full }] = page.problems, more = page.problems.length - 1;
    const place = where && (where === "resolution" || /[.[]/.test(where)) ? capital(placeName(where.replace(/^resolution\./, ""), page.system?.shells?.length ?? 1)) : where;
    box.textContent = `Not solved${full ? " at full resolution" : ""}: ${[place, inWords(problem)].filter(Boolean).join(": ")}${more ? ` (and ${more} more)` : ""}`;
  }
  else if (page.job && !page.job.full) box.textContent = `Solving the ${page.jobs.current ? "preview" : "bare system"} in three dimensions: ${Math.round(100 * page.job.fraction)}\u202f% ${page.job.stage ?? ""}`.trim();
  else if (page.stopped) box.textContent = "Stopped: not solved as it stands in the form.";
  else if (!current) box.textContent = "Solving…";
  else {
    const { modes, time_step } = current.resolution;
    const how = `${current.stations ? "three dimensions, " : ""}${modes} orders, step ${show(time_step, "")} a/c${current.seconds > 0.002 ? `, ${show(current.seconds, "s", 2)}` : ""}`; // less: it was there
    box.textContent = page.job ? `${current.full ? "Full resolution" : "Preview"} (${how}); full resolution: ${Math.round(100 * page.job.fraction)}\u202f% ${page.job.stage ?? ""}` : `${current.full ? "Full resolution" : "Preview"} (${how})`;
  }
}

// ---- setting up

// A start for a system of one's own: one steel shell in water.
const NOTHING = "nothing", plain = () => ({ name: NOTHING, system: { ...page.world.presets.find(({ name }) => name === "steel-tube").system, name: "new system" } });

function wire() {
  by("preset").addEventListener("change", (event) => { const name = event.target.value, preset = name === NOTHING ? plain() : page.world.presets[name]; if (preset) open({ system: preset.system }, preset.name); });
  by("quantity").addEventListener("change", (event) => { choose(event.target.value); drawRuns(); keepLink(); });
  by("station").addEventListener("change", (event) => { page.station = Number(event.target.value); drawRuns(); keepLink(); });
  by("shells").addEventListener("change", (event) => { page.which = event.target.value; drawRuns(); });
  by("unit").addEventListener("change", (event) => { page.unit = event.target.value; drawRuns(); keepLink(); });
  const back = (way) => () => { const found = way(state()); if (found) page.system = found.system; goTo(found); };
  by("undo").addEventListener("click", back(past.undo));
  by("redo").addEventListener("click", back(past.redo));
  past.onChange(({ undo, redo }) => { by("undo").disabled = !undo; by("redo").disabled = !redo; });
  by("pin").addEventListener("click", () => {
    if (page.runs.pinned) { slots.pinned.stopFull(); return drop("pinned"); }
    const { system } = page.runs.current;
    take("pinned", page.runs.current);
    slots.pinned.want(system, { resolution: preview(), full: page.resolution });
  });
  by("cancel").addEventListener("click", () => {
    page.stopped = Boolean(page.jobs.current && !page.jobs.current.full);
    if (inSpace()) { slots.bare.stopFull(); if (page.stopped) page.bareKey = ""; }
    slots.current.stopFull();
    if (page.stopped) stale(true);
    say();
  });
  by("refine").addEventListener("click", () => {
    if (page.stopped) return solve();
    slots.current.refine();
    return inSpace() && page.runs.bare && slots.bare.refine();
  });
  by("form").addEventListener("submit", (event) => event.preventDefault());
  document.addEventListener("theme", () => { if (page.runs.current) drawRuns(); });
  tabs.onTab((name) => { drawTab(name); if (name === "studies") studies.fit(); if (page.system) keepLink(); });
  addEventListener("load", () => Object.keys(page.runs).length && drawRuns()); // plotly is read after the first request has gone: by now it is there
  addEventListener("hashchange", ({ newURL }) => { // not what the address is now: that may have been kept of the form meanwhile
    const fragment = link.held(new URL(newURL).hash);
    return fragment && open({ fragment }, "a link", "/api/link/open");
  });
  files.setUp({ runs: () => page.runs, opened, described: content, films: () => page.world.films });
  studies.setUp(() => page, { preview, opened });
  designs.setUp(() => page, { previewOf, open, unit: () => page.unit, kept: guide.look });
  wave.setUp(curves.cursor);
  wall.setUp(curves.cursor);
  for (const panel of PANELS) panel.setUp();
  curves.onTime((time) => {
    const around = page.runs.current?.stations;
    wave.pause();
    if (!around || wave.ready()) wave.seek(time);
    if (around) wall.seek(time);
  });
  events.onRestart(() => { wave.forget(); energy.forget(); wall.forget(); for (const panel of [...PANELS, designs]) panel.forget(); again(); });
  events.onConnection((reachable) => { page.reachable = reachable; if (page.world) say(); });
  addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.target.matches("input[type=text], textarea")) return;
    const key = event.key.toLowerCase(), button = key === "y" || (key === "z" && event.shiftKey) ? by("redo") : key === "z" ? by("undo") : null;
    if (button && !button.disabled) { event.preventDefault(); button.click(); }
  });
}

async function begin() {
  try {
    page.world = await request("/api/schema");
  } catch (error) {
    by("state").textContent = `${told(error)}; trying again`;
    return setTimeout(begin, 1000);
  }
  page.resolution = { ...page.world.resolutions.full };
  form.setUp(page.world, change, () => page.system);
  section.setUp({ change, add: addAbsorber, remove: removeAbsorber, singly: placeSingly });
  by("preset").replaceChildren(el("option", { value: NOTHING, title: "One steel shell in water, to build on" }, "nothing: one shell"), ...page.world.presets.map((one, i) => el("option", { value: i, title: one.title }, one.name)), el("option", { value: "", hidden: true }));
  by("unit").replaceChildren(...Object.entries(curves.UNITS).map(([value, { name }]) => el("option", { value }, name)));
  events.listen();
  wire();
  const first = page.world.presets.find((one) => one.name === "hybrid"), fragment = link.held();
  guide.setUp(() => ({ ...page, tab: tabs.shown(), designs: designs.count() }));
  if (fragment && (await open({ fragment }, "a link", "/api/link/open"))) return;
  if (await open({ system: first.system }, first.name)) guide.begin();
}

// For the tests: how long the last changes took until their curves were drawn.
Object.defineProperty(window, "coaxshell", { value: { state: page, times } });
begin();
