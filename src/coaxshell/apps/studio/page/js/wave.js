// The wave: pressure around the shells and the stress on them, bare, pinned and current side by side, played or scrubbed.
import { request } from "./api.js";
import * as cuts from "./cuts.js";
import { by, el } from "./dom.js";
import { film, frameAt, pressureAt } from "./film.js";
import { STRESS_BAR, pressureBar, stressColour, words as colourWords } from "./maps.js";
import { colour } from "./theme.js";
import { show } from "./units.js";
import { told } from "./words.js";

const PANELS = [{ name: "bare", label: "Bare" }, { name: "pinned", label: "Pinned" }, { name: "current", label: "Current" }];
const PIXELS = 480; // of a canvas, a side
const SPEEDS = [[0.1, "0.1 transits/s"], [0.25, "0.25 transits/s"], [0.5, "0.5 transits/s"], [1, "1 transit/s"]];
const STEP = 0.05; // of the cross-hair by arrow keys, in units of a

const REST = 400; // ms without a move of the cross before its exact pressure is asked for

const films = {}; // by panel
const exact = {}; // by panel: the history of the pressure at the cross
const parts = {}; // elements
let shownAt; // called with the time shown
let runsNow = {}, cut = "", going = ""; // the runs to be shown; in three dimensions the cut; what is being loaded
let loading = null, time = 0, last = 0, playing = false, before = 0, probe = null, resting = 0, asking = false;

export function setUp(onTime) {
  shownAt = onTime;
  parts.play = el("button", { type: "button", id: "play", class: "main", onclick: () => (playing ? pause() : play()) }, "Play");
  parts.scrub = el("input", { type: "range", id: "scrub", min: 0, max: 1, step: "any", value: 0, "aria-label": "Time", oninput: () => { pause(); seek(Number(parts.scrub.value)); } });
  parts.speed = el("select", { id: "speed", "aria-label": "Speed" }, ...SPEEDS.map(([value, text]) => el("option", { value, selected: value === 0.5 }, text)));
  parts.time = el("output", { id: "wave-time", for: "scrub" });
  parts.state = el("p", { class: "note", id: "wave-state", role: "status" });
  parts.cut = el("select", { id: "wave-cut", "aria-label": "Cut", hidden: true, onchange: () => load(runsNow) });
  parts.ask = el("button", { type: "button", id: "wave-ask", hidden: true, onclick: () => { parts.cut.focus(); load(runsNow, true); } }, "Compute the wave");
  parts.stop = el("button", { type: "button", class: "quiet", id: "wave-stop", hidden: true, onclick: () => loading?.abort() }, "Cancel");
  parts.point = el("output", { class: "note", id: "wave-point" }, "Point at the field, or move the cross with the arrow keys, to read the pressure.");
  parts.scales = el("div", { class: "scales" });
  const panels = PANELS.map(({ name, label }) => {
    const canvas = el("canvas", { id: `field-${name}`, width: PIXELS, height: PIXELS, tabindex: 0, role: "img", "aria-label": `Pressure field of the ${name} system`, onpointermove: (event) => pointed(event, canvas), onpointerdown: (event) => pointed(event, canvas), onkeydown: keyed });
    parts[name] = canvas;
    return el("figure", { class: "field-panel", id: `panel-${name}` }, canvas, el("figcaption", {}, label));
  });
  by("wave").replaceChildren(el("div", { class: "player" }, parts.play, parts.scrub, parts.time, parts.speed), el("div", { class: "bar status" }, parts.cut, parts.ask, parts.state, parts.stop), el("div", { class: "fields" }, ...panels), parts.point, parts.scales);
}

// Load the films of the runs unless they are there; the newest call wins. In three dimensions they wait until it is asked for them,
// since they take long: how long is told beside the button.
export async function load(runs, sure = false) {
  const wanted = PANELS.filter(({ name }) => runs[name]), around = Boolean(runs.current?.stations);
  runsNow = runs;
  parts.cut.hidden = !around;
  cut = around ? cuts.chosen(parts.cut, runs.current.stations) : "";
  const mineIs = ({ name }) => films[name]?.run === runs[name].run && films[name].cut === cut;
  for (const { name } of PANELS) {
    by(`panel-${name}`).hidden = !runs[name];
    if (!runs[name]) delete films[name];
    aged(name, Boolean(films[name]) && !mineIs({ name }));
  }
  by("wave").querySelector(".fields").dataset.count = wanted.length;
  // All share the colours of the first one, the bare system, so that they can be compared.
  const there = (one) => mineIs(one) && films[one.name].limit === films[wanted[0].name]?.limit, key = JSON.stringify([cut, ...wanted.map(({ name }) => runs[name].run)]);
  parts.ask.hidden = true;
  if (wanted.every(there)) return draw();
  if (around && loading && going === key) return null;
  loading?.abort();
  if (around && !sure) return offered(runs.current, wanted.filter((one) => !mineIs(one)).length, key);
  const mine = (loading = new AbortController());
  going = key;
  parts.stop.hidden = false;
  const shares = {};
  const progress = () => { parts.state.textContent = `Computing the field: ${Math.round((100 * Object.values(shares).reduce((a, b) => a + b, 0)) / wanted.length)}\u202f%`; };
  try {
    for (const one of wanted) {
      const { name } = one;
      shares[name] = 0;
      progress();
      const ends = one === wanted[0] ? null : films[wanted[0].name].limit;
      if (!there(one)) films[name] = await film(runs[name], mine.signal, (fraction) => { shares[name] = fraction; progress(); }, ends, cut);
      aged(name, false);
      shares[name] = 1;
    }
    parts.state.textContent = "";
    last = Math.max(...wanted.map(({ name }) => films[name].time.at(-1)));
    parts.scrub.max = last;
    draw();
    moved();
  } catch (failure) {
    parts.state.textContent = failure.name === "AbortError" ? (loading === mine ? "Cancelled." : parts.state.textContent) : told(failure);
  }
  if (loading === mine) { loading = null; parts.stop.hidden = true; if (around && !wanted.every(mineIs)) parts.ask.hidden = false; }
  return null;
}

// What has not been computed yet, and how long it would take.
async function offered(answer, count, key) {
  loading = null;
  going = key;
  parts.ask.hidden = false;
  parts.stop.hidden = true;
  parts.ask.textContent = "Compute the wave";
  parts.state.textContent = "";
  try {
    const costs = await cuts.costsOf(answer);
    if (going === key) parts.ask.textContent = `Compute the wave, about ${cuts.inTime(count * costs[cuts.asked(cut).plane].seconds)}`;
  } catch (failure) { if (going === key) parts.state.textContent = told(failure); }
}

// Whether there is something to be seen at an instant.
export const ready = () => Boolean(first());

// The film of an earlier state stays until the new one is there, and says so.
function aged(name, old) {
  parts[name].classList.toggle("old", old);
  parts[name].nextElementSibling.textContent = `${PANELS.find((one) => one.name === name).label}${old ? ": the state before, until the new one is computed" : ""}`;
}

export function forget() { for (const name of Object.keys(films)) delete films[name]; }

export function seek(to) {
  time = Math.min(Math.max(to, 0), last);
  parts.scrub.value = time;
  draw();
  shownAt(time);
}

export function pause() { playing = false; parts.play.textContent = "Play"; }

function play() {
  if (!Object.keys(films).length) return;
  if (time >= last) time = 0;
  playing = true;
  before = performance.now();
  parts.play.textContent = "Pause";
  requestAnimationFrame(tick);
}

function tick(now) {
  if (!playing) return;
  const next = time + ((now - before) / 1000) * Number(parts.speed.value);
  before = now;
  if (next >= last) pause();
  seek(next);
  if (playing) requestAnimationFrame(tick);
}

const first = () => films[PANELS.find(({ name }) => films[name])?.name];

export function draw() {
  const shown = first();
  if (!shown) return;
  parts.time.textContent = `t = ${time.toFixed(2)} (${show(time * shown.transit_time_seconds, "s", 3)})`;
  const limit = { pressure: shown.limit, stress: shown.stress_limit };
  for (const { name } of PANELS) if (films[name]) panel(parts[name], films[name], limit);
  parts.scales.replaceChildren(scale("pressure", limit.pressure, pressureBar()), scale("hoop stress", limit.stress, STRESS_BAR));
  read();
}

const buffers = new WeakMap();

function panel(canvas, one, limit) {
  const { size } = one, frame = frameAt(one, time), context = canvas.getContext("2d");
  if (buffers.get(canvas)?.width !== size) buffers.set(canvas, new OffscreenCanvas(size, size));
  const buffer = buffers.get(canvas), inner = buffer.getContext("2d"), image = inner.createImageData(size, size);
  const words = new Uint32Array(image.data.buffer), tints = colourWords(), start = frame * size * size;
  for (let line = 0; line < size; line += 1) {
    const from = start + (size - 1 - line) * size, to = line * size; // the lowest y comes first
    for (let column = 0; column < size; column += 1) words[to + column] = tints[one.pressure[from + column]];
  }
  inner.putImageData(image, 0, 0);
  context.imageSmoothingEnabled = true;
  context.drawImage(buffer, 0, 0, PIXELS, PIXELS);
  if (one.plane === "along") cuts.walls(context, one, frame, limit, PIXELS); else rings(context, one, frame, limit);
  dots(context, one);
  cross(context, one);
  canvas.setAttribute("aria-label", `Pressure field of the ${canvas.id.slice(6)} system${cuts.told(one)}`);
}

function rings(context, one, frame, limit) {
  const toPixels = PIXELS / (2 * one.half_width), centre = PIXELS / 2;
  context.lineCap = "butt";
  one.radii.forEach((radius, shell) => {
    const stress = one.rings.get(shell);
    context.lineWidth = 7;
    context.strokeStyle = "rgb(60 60 60)";
    context.beginPath();
    context.arc(centre, centre, radius * toPixels, 0, 2 * Math.PI);
    context.stroke();
    if (!stress) return;
    context.lineWidth = 5;
    for (let degree = 0; degree < 360; degree += 2) {
      const from = (-(degree - 1) * Math.PI) / 180, to = (-(degree + 1.2) * Math.PI) / 180;
      context.strokeStyle = stressColour(stress[frame * 360 + degree] / limit.stress);
      context.beginPath();
      context.arc(centre, centre, radius * toPixels, from, to, true);
      context.stroke();
    }
  });
}

function dots(context, one) {
  const toPixels = PIXELS / (2 * one.half_width), centre = PIXELS / 2;
  context.fillStyle = colour("text");
  for (const [x, y] of one.absorbers) {
    context.beginPath();
    context.arc(centre + x * toPixels, centre - y * toPixels, 2.4, 0, 2 * Math.PI);
    context.fill();
  }
}

function cross(context, one) {
  if (!probe) return;
  const toPixels = PIXELS / (2 * one.half_width), x = PIXELS / 2 + probe.x * toPixels, y = PIXELS / 2 - probe.y * toPixels;
  context.strokeStyle = colour("text");
  context.lineWidth = 1.2;
  context.beginPath();
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) { context.moveTo(x + 3 * dx, y + 3 * dy); context.lineTo(x + 9 * dx, y + 9 * dy); }
  context.stroke();
}

function scale(label, limit, gradient) {
  return el("div", { class: "scale" }, el("span", {}, show(-limit, "Pa", 3)), el("i", { style: `background:${gradient}`, "aria-hidden": "true" }), el("span", {}, show(limit, "Pa", 3)), el("span", { class: "name" }, label));
}

function pointed(event, canvas) {
  const one = first(), box = canvas.getBoundingClientRect();
  if (!one || !box.width) return;
  probe = { x: ((event.clientX - box.left) / box.width * 2 - 1) * one.half_width, y: (1 - ((event.clientY - box.top) / box.height) * 2) * one.half_width };
  if (playing) read(); else draw();
  moved();
}

function keyed(event) {
  const turn = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] }[event.key];
  if (event.key === " ") { event.preventDefault(); parts.play.click(); }
  if (!turn) return;
  event.preventDefault();
  probe = { x: (probe?.x ?? 0) + turn[0], y: (probe?.y ?? 0) + turn[1] };
  draw();
  moved();
}

// Once the cross rests, its pressure over the whole run: the picture has few levels, and none beyond the ends of its colours.
function moved() {
  clearTimeout(resting);
  if (probe) resting = setTimeout(ask, REST);
}

async function ask() {
  if (asking) return moved();
  asking = true;
  const { x, y } = probe;
  for (const { name } of PANELS) {
    const run = films[name]?.run; // asked for late: a film may have gone meanwhile
    if (!run || films[name].cut || (exact[name]?.run === run && exact[name].x === x && exact[name].y === y)) continue;
    const answer = await request(`/api/runs/${run}/point?x=${x}&y=${y}`).catch(() => null);
    if (answer?.arrays) exact[name] = { run, x, y, time: answer.arrays.time.values, pressure: answer.arrays.pressure.values };
    read();
  }
  asking = false;
}

// The exact pressure at the cross and the time shown, or null while it is not known.
function exactly(name) {
  const { run, x, y, time: times, pressure } = exact[name] ?? {};
  if (run !== films[name].run || x !== probe.x || y !== probe.y) return null;
  const place = (time - times[0]) / (times[1] - times[0]), low = Math.min(Math.max(Math.floor(place), 0), times.length - 2);
  return pressure[low] + Math.min(place - low, 1) * (pressure[low + 1] - pressure[low]);
}

function read() {
  if (!probe) return;
  const at = `x = ${probe.x.toFixed(2)}, ${first()?.plane === "along" ? "z" : "y"} = ${probe.y.toFixed(2)} (radii)`.replaceAll("-", "−");
  const values = PANELS.filter(({ name }) => films[name]).map(({ name, label }) => `${label.toLowerCase()} ${reading(name)}`);
  parts.point.textContent = `${at}: ${values.join(", ")}`;
}

function reading(name) {
  const value = exactly(name);
  if (value !== null) return show(value, "Pa", 3);
  const seen = pressureAt(films[name], frameAt(films[name], time), probe.x, probe.y);
  if (seen !== null && Math.abs(seen) >= 0.999 * films[name].limit) return `${seen < 0 ? "below" : "above"} ${show(seen, "Pa", 3)}`;
  return seen === null ? "–" : `about ${show(seen, "Pa", 2)}`;
}

document.addEventListener("theme", () => { if (colour("text")) draw(); });
