// Peak and RMS values as bars, with how they stand to others; warnings in plain words above them.
import { el, by, svg } from "./dom.js";
import { RUNS } from "./curves.js";
import { placeText } from "./space.js";
import { inComparison, percent, show } from "./units.js";
import { capital, inWords, shellPhrase } from "./words.js";

let shown = []; // of which runs the bars are, and over how long

export function draw(runs) {
  const { current } = runs;
  if (!current) return;
  by("peaks").classList.toggle("unmeasured", !current.withBars);
  const now = [runs.current, runs.bare, runs.pinned].map((run) => run?.bars).concat(current.resolution.duration, current.transit_time_seconds);
  if (!current.withBars && now.every((one, i) => one === shown[i])) return drawJudgement(current); // those of the run before, until its own come
  shown = now;
  const others = ["bare", "pinned"].filter((key) => runs[key]);
  const table = el("table", { class: "peaks" },
    el("caption", {}, `Largest magnitudes ${current.stations ? "over all stations and " : ""}over ${show(current.resolution.duration, "")} transits (${show(current.resolution.duration * current.transit_time_seconds, "s")})`),
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Quantity"), el("td", {}), el("th", { scope: "col", class: "number" }, "Current"), current.stations && el("th", { scope: "col", class: "number" }, "Station"), ...others.flatMap((key) => [el("th", { scope: "col", class: "number" }, RUNS[key].name.replace(/^./, (c) => c.toUpperCase())), el("th", { scope: "col", class: "number" }, "Change")]))),
    ...groups(current).map(([title, bars]) => el("tbody", {}, el("tr", {}, el("th", { scope: "rowgroup", colspan: 3 + Boolean(current.stations) + 2 * others.length }, title)), ...bars.map((bar) => line(bar, runs, others, extent(bar, current, runs, others))))));
  const region = el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "Peak and RMS values" }, table);
  const wide = [region, ...(current.stations?.length > 1 ? [along(current)] : [])], hint = () => el("p", { class: "scroll-hint", "aria-hidden": "true" }, "← swipe the table to see all of it →");
  by("peaks").replaceChildren(...wide.flatMap((one) => [one, hint()]), el("p", { class: "note accuracy" }));
  drawJudgement(current);
  for (const one of wide) one.classList.toggle("scrolls", one.scrollWidth > one.clientWidth + 1);
}

// What is largest at each station of a run in three dimensions: a row a quantity, a column a station.
function along(current) {
  const { stations, station_bars: each } = current;
  const rows = groups({ ...current, bars: each[0] }).map(([title, bars]) => el("tbody", {}, el("tr", {}, el("th", { scope: "rowgroup", colspan: 1 + stations.length }, title)),
    ...bars.map((bar) => {
      const values = each.map((of) => of.find((one) => one.name === bar.name && one.shell === bar.shell).value), most = Math.max(...values);
      return el("tr", {}, el("th", { scope: "row" }, bar.label), ...values.map((value) => el("td", { class: `number${value === most ? " most" : ""}` }, show(value, bar.unit))));
    })));
  return el("div", { class: "wide", role: "region", tabindex: 0, "aria-label": "Largest magnitudes at each station" }, el("table", { class: "peaks along" },
    el("caption", {}, "Largest magnitudes of the current system at each station"),
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Quantity"), ...stations.map((z) => el("th", { scope: "col", class: "number" }, placeText(z))))), ...rows));
}

// Warnings above the table and the accuracy below it. They come a moment after the rest; until then those of the run before stand there, muted.
export function drawJudgement(current) {
  const panel = by("peaks"), note = panel.querySelector(".accuracy");
  if (!current || !note) return;
  panel.querySelector(".warnings")?.remove();
  if (current.warnings.length) panel.prepend(el("ul", { class: "warnings", "aria-label": "Warnings" }, ...current.warnings.map((text) => el("li", {}, sentence(text)))));
  note.textContent = accuracy(current);
  panel.classList.toggle("unjudged", !current.judged);
}

function groups(result) {
  const named = result.shells.map((shell) => [`${capital(shellPhrase(shell.index, result.shells.length))}, ${show(shell.radius, "m")}`, result.bars.filter((bar) => bar.shell === shell.index)]);
  const rest = result.bars.filter((bar) => bar.shell === undefined || bar.shell === null);
  return [...named, ["Absorbers", rest]].filter(([, bars]) => bars.length);
}

const twin = (run, bar) => run?.bars.find((one) => one.name === bar.name && (one.shell ?? null) === (bar.shell ?? null));

// Bars of one unit share a scale, so that their lengths can be compared down the table.
function extent(bar, current, runs, others) {
  const alike = current.bars.filter((one) => one.unit === bar.unit && one.name.split("_")[0] === bar.name.split("_")[0]);
  return Math.max(...alike.flatMap((one) => [one.value, ...others.map((key) => twin(runs[key], one)?.value ?? 0)]));
}

function line(bar, runs, others, most) {
  const width = (value) => `${most ? Math.max(0, (100 * value) / most) : 0}%`;
  const pairs = others.map((key) => [key, twin(runs[key], bar)]);
  const height = 15 / (1 + others.length);
  const picture = svg("svg", { "aria-hidden": "true" }, svg("rect", { x: 0, y: 1, height: height + 1, width: width(bar.value), rx: 1.5, fill: "var(--current)" }),
    ...pairs.map(([key, other], i) => svg("rect", { x: 0, y: 2 + (i + 1) * height, height: height - 1, width: width(other?.value ?? 0), rx: 1, fill: `var(--${RUNS[key].colour})` })));
  const where = bar.time === null || bar.time === undefined ? "" : `at t = ${show(bar.time, "")} a/c (${show(bar.time * runs.current.transit_time_seconds, "s")})${bar.angle === null || bar.angle === undefined ? "" : `, ${show(bar.angle, "deg")}`}${bar.growing ? ", still growing" : ""}`;
  return el("tr", { title: where }, el("th", { scope: "row" }, bar.label), el("td", { class: "bars" }, picture), el("td", { class: "number", "data-bar": `${bar.name}/${bar.shell ?? ""}` }, show(bar.value, bar.unit)),
    runs.current.stations && el("td", { class: "number" }, bar.station === undefined ? "" : placeText(bar.station)),
    ...pairs.flatMap(([, other]) => {
      // What still grows at the end of its run depends on the length of the run: how it stands to another says nothing.
      const grows = bar.growing || other?.growing;
      const change = other === undefined || grows ? null : percent(bar.value, other.value);
      const kind = change === null || Math.abs(change) < 0.05 ? "" : change < 0 ? "better" : "worse";
      return [el("td", { class: "number" }, show(other?.value ?? null, bar.unit)), el("td", { class: `number ${kind}` }, other && grows ? "still growing" : inComparison(change))];
    }));
}

function accuracy({ estimates, full, judged, unjudged, resolution }) {
  if (!judged) return "Errors and warnings of this run follow.";
  if (unjudged) return `Errors and warnings of this run cannot be given: ${unjudged}.`;
  const worst = Math.max(...estimates.stress.filter((one) => one !== null), 0);
  const axial = Math.max(...estimates.errors.map(({ stress }) => stress["axial wavenumbers"] ?? 0), 0);
  const waves = resolution.dimensions === 3 ? `, from the axial wavenumbers left out: ${show(axial, "", 2)}` : "";
  return `Estimated relative error of the stress from the orders left out: ${show(worst, "", 2)}${waves} at ${resolution.modes} orders, step ${show(resolution.time_step, "")} a/c${full ? "" : " (preview)"}.`;
}

const sentence = (text) => capital(inWords(text)) + (/[.!?]$/.test(text) ? "" : ".");
