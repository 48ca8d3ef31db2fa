// Taking things home and bringing them in: downloads, a film, a link that holds the whole system, a file opened.
import { client, request } from "./api.js";
import * as designs from "./designs.js";
import { by, el, toast } from "./dom.js";
import { ended, watch } from "./events.js";
import * as link from "./link.js";
import * as tabs from "./tabs.js";
import { told } from "./words.js";

const FILES = [
  ["download.toml", "Scenario", "TOML, for coaxshell run"],
  ["download.nc", "Response", "NetCDF, arrays and scenario"],
  ["download.csv", "Histories", "CSV, head and tail"],
  ["figure.png", "Stress figure", "PNG"],
  ["figure.svg", "Stress figure", "SVG"],
];
const TOGETHER = ["bare", "pinned", "current"]; // what a figure and a film show, the first ones first
const making = {}; // the ids of the jobs of a film and a report being made
let format = "mp4";

const KINDS = { toml: "application/toml", nc: "application/x-netcdf" };

export function setUp({ runs, opened, described, films }) {
  const button = by("download").querySelector("button"), list = by("download-list");
  const toggle = (open) => { list.hidden = !open; button.setAttribute("aria-expanded", String(open)); };
  button.addEventListener("click", () => {
    if (!runs().current) return toast("Nothing solved yet.");
    [format] = films();
    fill(list, runs(), () => toggle(false));
    toggle(list.hidden);
  });
  document.addEventListener("click", (event) => { if (!by("download").contains(event.target)) toggle(false); });
  by("download").addEventListener("keydown", (event) => { if (event.key === "Escape") { toggle(false); button.focus(); } });
  by("open").addEventListener("click", () => by("file").click());
  by("file").addEventListener("change", () => { const [file] = by("file").files; by("file").value = ""; if (file) upload(file, opened); });
  by("link").addEventListener("click", () => copyLink(described()));
}

const together = (runs) => [...new Set(TOGETHER.map((name) => runs[name]?.run).filter(Boolean))];

function fill(list, runs, close) {
  const run = runs.current.run, compare = together(runs).filter((name) => name !== run).map((name) => `compare=${encodeURIComponent(name)}`).join("&");
  const query = (path) => (path.startsWith("figure") && compare ? `?${compare}` : "");
  const act = (what) => () => { close(); what(); };
  list.replaceChildren(...FILES.map(([path, name, kind]) => el("li", {}, el("a", { href: `/api/runs/${run}/${path}${query(path)}`, download: "", onclick: close }, name, el("small", {}, kind)))),
    el("li", {}, making.report ? el("button", { type: "button", onclick: act(() => cancel("report")) }, "Cancel the report") : el("button", { type: "button", id: "report", onclick: act(() => report(runs)) }, "Report", el("small", {}, "one HTML file, about a minute"))),
    el("li", {}, making.film ? el("button", { type: "button", id: "no-film", onclick: act(() => cancel("film")) }, "Cancel the film")
      : el("button", { type: "button", id: "film", onclick: act(() => film(runs)) }, "Film", el("small", {}, `${format === "mp4" ? "MP4" : "WebP"}, side by side${runs.current.stations ? ", across and along; minutes" : ""}`))));
}

const film = (runs) => make({ kind: "film", runs: together(runs), frames: 120, fps: 24, size: 360, format });
// Of the current system, against the pinned one or else the bare one.
const report = ({ current, pinned, bare }) => make({ kind: "report", runs: [...new Set([current, pinned ?? bare].filter(Boolean).map(({ run }) => run))], ...(current.stations ? { without: ["energy", "fields"] } : {}) });
const cancel = (kind) => request(`/api/jobs/${making[kind]}`, { method: "DELETE" }).catch(() => {});

// A file that takes a while: its progress is told, and the finished one saved.
async function make(body) {
  const { kind } = body, word = kind.replace(/^./, (letter) => letter.toUpperCase());
  try {
    const { job, problem } = await request("/api/jobs", { body: { client, ...body } });
    if (!job) return toast(`No ${kind}: ${told(problem)}`);
    making[kind] = job.id;
    watch(job, (now) => {
      if (!ended(now)) return toast(`${word}: ${Math.round(100 * (now.fraction ?? 0))}\u202f%`);
      delete making[kind];
      if (now.state === "cancelled") return toast(`No ${kind}: cancelled.`);
      if (now.state !== "done") return toast(`No ${kind}: ${told({ problem: now.error })}`);
      const anchor = el("a", { href: `/api/jobs/${now.id}/file`, download: "" });
      document.body.append(anchor);
      anchor.click();
      anchor.remove();
      return toast(`The ${kind} is done.`);
    });
  } catch (failure) { toast(told(failure)); }
  return null;
}

async function upload(file, opened) {
  const type = KINDS[file.name.split(".").at(-1).toLowerCase()];
  if (!type) return toast(`${file.name}: give a .toml or a .nc file`);
  try {
    if (type === KINDS.toml && designs.isProject(await file.text())) { tabs.choose("designs"); return designs.openText(await file.text()); }
    const answer = await request("/api/upload", { body: file, type });
    if (answer.ok) { opened(answer, file.name); return toast(`Opened ${file.name}.`); }
    return toast(`${file.name}: ${told(answer.problem)}`);
  } catch (failure) { return toast(told(failure)); }
}

async function copyLink(described) {
  try {
    const samples = await link.put(described);
    const holds = samples ? `it holds the system, but its record of ${samples.toLocaleString("en")} samples only as long as this server runs. To keep or share it: Download, Scenario.` : "it holds the whole system.";
    try { await navigator.clipboard.writeText(location.href); toast(`Link copied: ${holds}`); } catch { toast(`The link stands in the address bar: ${holds}`); }
  } catch (failure) { toast(told(failure)); }
}
