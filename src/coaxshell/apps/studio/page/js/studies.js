// Studies from the page: what kind, its form, its study file, jobs watched and cancelled, results opened.
import { client, request } from "./api.js";
import { by, el, saveText } from "./dom.js";
import { ended, onRestart, watch } from "./events.js";
import * as optimise from "./optimise.js";
import { fields, spelt } from "./study_fields.js";
import * as sweep from "./sweep.js";
import { show } from "./units.js";
import { refusal, told } from "./words.js";

const KINDS = { sweep, optimise };
const jobs = new Map(); // by id: { kind, title, row, state }
const LATER = [0, 1000, 4000, 15_000]; // ms after the page's beginning: the server may hear late that the page before has gone
let kind = "sweep", world, redraw = () => {}, fileTimer;

// `page` holds what main.js does; `preview` gives its coarse resolution; `opened` adopts a system.
export function setUp(page, { preview, opened }) {
  world = { page, preview, opened };
  const forms = Object.keys(KINDS).map((name) => el("form", { id: name, class: "study", novalidate: true, autocomplete: "off", hidden: name !== kind, onsubmit: (event) => { event.preventDefault(); start(); } }));
  by("studies").replaceChildren(el("div", {},
    el("fieldset", { class: "segments" }, el("legend", { class: "hidden" }, "Kind of study"), ...Object.entries(KINDS).map(([name, { title }]) =>
      el("label", {}, el("input", { type: "radio", name: "study-kind", value: name, checked: name === kind, onchange: () => choose(name) }), el("span", {}, title)))),
    ...forms,
    el("details", { id: "study-file", class: "study-file", ontoggle: keepFile }, el("summary", {}, "Study file, for the command line"),
      el("textarea", { id: "study-text", readonly: true, rows: 16, spellcheck: "false", "aria-label": "Study file" }),
      el("div", { class: "buttons" }, el("button", { type: "button", onclick: copy }, "Copy"), el("button", { type: "button", id: "study-save", onclick: () => saveText(by("study-text").value, "study.toml") }, "Save"), el("code", { id: "study-command" })))),
    el("div", {}, el("p", { class: "hidden", id: "study-said", role: "status" }), el("div", { id: "study-jobs" }), el("div", { id: "study-result" })));
  for (const form of forms) {
    KINDS[form.id].setUp(form, page);
    for (const type of ["input", "change", "click"]) form.addEventListener(type, keepFile);
  }
  document.addEventListener("theme", () => redraw());
  for (const pause of LATER) setTimeout(takeOver, pause);
  onRestart(() => { for (const one of jobs.values()) one.row.remove(); jobs.clear(); });
}

function choose(name) {
  kind = name;
  for (const other of Object.keys(KINDS)) by(other).hidden = other !== name;
  offer();
}

// Bring the form up to date with the system, unless somebody is at it.
export function offer() {
  const { system, metrics } = world.page(), form = by(kind);
  if (!system || form.contains(document.activeElement)) return;
  const key = JSON.stringify([fields().map(({ path }) => path), metrics]); // a slider's every step comes by here
  if (form.offered !== key) KINDS[kind].offer(form);
  form.offered = key;
  keepFile();
}

// A plot that was drawn while another tab was shown did not know how much room it has.
export function fit() {
  if (by("study-plot")?.data) window.Plotly.Plots.resize(by("study-plot"));
}

function asked() {
  return { resolution: world.preview(), ...KINDS[kind].body(by(kind)), system: world.page().system };
}

async function start() {
  const body = asked(), { mark, named, missing } = KINDS[kind], form = by(kind), lack = missing?.() ?? null;
  mark(form, lack);
  if (lack) return;
  try {
    const title = named(body), answer = await request("/api/jobs", { body: { client, title: title.slice(0, 200), ...body } });
    if (answer.ok === false) return mark(form, answer.problem);
    list(answer.job, title);
    return inSight(by("study-jobs"));
  } catch (failure) { return mark(form, refusal(failure)); }
}

// ---- jobs

// What this page had started before it was loaded anew, or another one that has gone.
async function takeOver() {
  try {
    for (const job of (await request("/api/studies", { body: { client } })).jobs) if (!jobs.has(job.id)) list(job, job.title || KINDS[job.kind].title, { quiet: job.state === "done" });
  } catch { /* the page says by itself that the server does not answer */ }
}

// `quiet`: it is not opened by itself.
function list(job, title, { quiet = false } = {}) {
  const row = el("div", { class: "job" });
  jobs.set(job.id, { kind: job.kind, title, row, state: "", quiet });
  by("study-jobs").prepend(row);
  watch(job, follow);
}

function follow(job) {
  const one = jobs.get(job.id);
  if (!one) return;
  if (job.state !== one.state) { // made anew only then, so that a button under a finger or with the focus stays
    one.state = job.state;
    one.row.dataset.state = job.state;
    one.row.replaceChildren(...parts(job, one));
    by("study-said").textContent = `${one.title}: ${job.state}`;
    if (job.state === "done" && !one.quiet) open(job.id);
  }
  if (ended(job)) return;
  const [bar, note] = one.row.querySelectorAll("progress, .note");
  bar.value = job.fraction ?? 0;
  note.textContent = [progressed(job), job.seconds_left ? `${show(job.seconds_left, "s", 2)} left` : ""].filter(Boolean).join(", ");
}

function parts(job, { kind: of, title }) {
  const name = el("span", { class: "name" }, title);
  if (!ended(job)) return [name, el("progress", { max: 1, value: 0, "aria-label": title }), el("span", { class: "note" }), el("button", { type: "button", class: "quiet", onclick: () => request(`/api/jobs/${job.id}`, { method: "DELETE" }).catch(() => {}) }, "Cancel")];
  if (job.state !== "done") return [name, el("span", { class: "note" }, job.state === "failed" ? told(job.error) : job.state)];
  const file = (text, query = "") => el("a", { href: `/api/jobs/${job.id}/file${query}`, download: "", "aria-label": `${text} of ${title}` }, text);
  return [name, el("span", { class: "note" }, `${job.state}, ${show(job.seconds, "s", 2)}`), el("button", { type: "button", class: "quiet", onclick: () => open(job.id) }, "Show"), ...(of === "sweep" ? [file("NetCDF")] : [file("TOML", "?what=toml"), file("CSV", "?what=csv")])];
}

function progressed({ state, stage }) {
  if (state !== "running") return state;
  const [, number, words] = stage.match(/^(\d+): (.*)$/) ?? [null, "", stage];
  return `${number ? `${number} designs, ` : ""}${spelt(words)}`.replace(/(^|\s)-(?=\d)/g, "$1−");
}

async function open(id) {
  const box = by("study-result");
  try {
    redraw = KINDS[jobs.get(id).kind].show(await request(`/api/jobs/${id}/result`), box, { id, ...world }) ?? (() => {});
    inSight(box);
  } catch (failure) { box.replaceChildren(el("p", { class: "problem" }, told(failure))); }
}

// What has just come is not left below the fold, unless somebody is typing above it.
function inSight(box) {
  if (!document.activeElement?.matches("input[type=text], select, textarea")) box.scrollIntoView({ block: "nearest" });
}

// ---- the study file

function keepFile() {
  clearTimeout(fileTimer);
  if (by("study-file").open) fileTimer = setTimeout(file, 250);
}

async function file() {
  const box = by("study-text");
  by("study-command").textContent = `coaxshell ${kind} study.toml`;
  try {
    const answer = await request("/api/study", { body: asked() });
    box.value = answer.ok ? answer.toml : `# not yet: ${told(answer.problem)}`;
  } catch (failure) { box.value = `# ${told(failure)}`; }
}

async function copy({ target }) {
  by("study-text").select();
  try { await navigator.clipboard.writeText(by("study-text").value); target.textContent = "Copied"; } catch { target.textContent = "Marked: copy it with Ctrl-C"; }
  setTimeout(() => { target.textContent = "Copy"; }, 2000);
}
