// A shell's wall laid flat: angle across, axial position up, coloured by a stress, at any instant of a run in three dimensions.
import { request } from "./api.js";
import { row } from "./arrays.js";
import { SETTINGS, UNITS, frame } from "./curves.js";
import { by, el } from "./dom.js";
import { finished } from "./events.js";
import { STRESS_SCALE } from "./maps.js";
import { prefixed, show } from "./units.js";
import { capital, shellPhrase, told } from "./words.js";

const QUANTITIES = [["stress", "Hoop stress"], ["axial_stress", "Axial stress"], ["shear_stress", "Shear stress"], ["von_mises_stress", "von Mises stress"]];
const parts = {}, kept = new Map(); // answers by run, shell and quantity
const MOST = 8;
let shownAt = () => {}, shown = null, wanted = "", work = null, run = null, unit = "transits", shell = null, quantity = "stress", time = null;

export function setUp(onTime) {
  shownAt = onTime;
  parts.shell = el("select", { id: "wall-shell", "aria-label": "Shell", onchange: () => { shell = Number(parts.shell.value); draw(run, unit); } });
  parts.quantity = el("select", { id: "wall-quantity", "aria-label": "Stress", onchange: () => { quantity = parts.quantity.value; draw(run, unit); } }, ...QUANTITIES.map(([value, text]) => el("option", { value }, text)));
  parts.scrub = el("input", { type: "range", id: "wall-scrub", min: 0, max: 1, step: 1, value: 0, "aria-label": "Time", oninput: () => { time = shown?.answer.arrays.time.values[Number(parts.scrub.value)] ?? null; picture(); shownAt(time); } });
  parts.time = el("output", { id: "wall-time", for: "wall-scrub" });
  parts.state = el("p", { class: "note", role: "status", id: "wall-state" });
  parts.stop = el("button", { type: "button", class: "quiet", hidden: true, onclick: () => work?.cancel() }, "Cancel");
  parts.plot = el("div", { id: "wall-plot", class: "wall-plot" });
  by("wall").replaceChildren(el("div", { class: "player" }, parts.shell, parts.quantity, parts.scrub, parts.time), el("div", { class: "bar status" }, parts.state, parts.stop), parts.plot);
}

export function forget() { kept.clear(); shown = null; wanted = ""; }

// The wall of a run; what is there at once is drawn at once, anything else is asked for.
export async function draw(now, timeUnit) {
  [run, unit] = [now, timeUnit];
  shells();
  const key = `${run.run}/${shell}/${quantity}`;
  if (kept.has(key)) { wanted = key; shown = { key, answer: kept.get(key) }; said(""); return picture(); }
  if (wanted === key) return null;
  work?.cancel();
  wanted = key;
  parts.plot.classList.toggle("old", Boolean(shown));
  const mine = (work = finished({ kind: "unrolled", run: run.run, shell, quantity }, ({ fraction }) => work === mine && said(`Reading the wall: ${Math.round(100 * (fraction ?? 0))}\u202f%`, true)));
  try {
    const job = await mine.promise, answer = await request(`/api/jobs/${job.id}/result`);
    if (work !== mine) return null;
    kept.set(key, answer);
    if (kept.size > MOST) kept.delete(kept.keys().next().value);
    shown = { key, answer };
    said("");
    picture();
  } catch (failure) {
    if (work === mine) { said(failure.cancelled ? "Cancelled." : told(failure)); wanted = ""; }
  }
  return null;
}

function said(text, busy = false) {
  parts.state.textContent = text;
  parts.stop.hidden = !busy;
}

function shells() {
  const elastic = run.shells.filter((one) => !one.rigid);
  if (!elastic.some((one) => one.index === shell)) shell = elastic.at(-1)?.index ?? 0;
  const options = elastic.map((one) => el("option", { value: one.index, selected: one.index === shell }, capital(shellPhrase(one.index, run.shells.length))));
  if (parts.shell.textContent !== options.map((one) => one.textContent).join("")) parts.shell.replaceChildren(...options);
}

// The instant at which the wall is loudest is shown first: later ones are chosen by hand.
function first({ values, shape }) {
  const size = shape[1] * shape[2];
  let most = 0, at = 0;
  for (let i = 0; i < values.length; i++) if (Math.abs(values[i]) > most) { most = Math.abs(values[i]); at = i; }
  return Math.floor(at / size);
}

function picture() {
  if (!shown || !window.Plotly) return;
  const { answer } = shown, { time: times, z, angle, values } = answer.arrays, count = times.values.length;
  const number = time === null ? first(values) : Math.min(Math.max(times.values.findLastIndex((one) => one <= time + 1e-6), 0), count - 1);
  parts.scrub.max = count - 1;
  parts.scrub.value = number;
  const now = times.values[number], { name, of } = UNITS[unit];
  parts.time.textContent = `t = ${show(now * of(run), "", 4)} ${name}`;
  parts.scrub.setAttribute("aria-valuetext", parts.time.textContent);
  parts.plot.classList.remove("old");
  const scale = prefixed("Pa", answer.limit), height = z.values.length, wall = Array.from({ length: height }, (_, i) => Float32Array.from(row(values, number * height + i), (one) => one / scale.factor));
  const { style, axis, layout } = frame({ height: 340, hovermode: "closest" }), ends = answer.limit / scale.factor;
  Object.assign(layout, { margin: { l: 62, r: 12, t: 12, b: 48 }, uirevision: "wall",
    xaxis: { ...axis, title: { text: "angle (°)", font: style, standoff: 6 }, tickvals: [-180, -90, 0, 90, 180], range: [-180, 180], zeroline: false },
    yaxis: { ...axis, title: { text: "z (m)", font: style }, range: [z.values[0], z.values.at(-1)], zeroline: false } });
  const trace = { type: "heatmap", x: angle.values, y: z.values, z: wall, zsmooth: "best", zmin: answer.signed ? -ends : 0, zmax: ends, colorscale: answer.signed ? STRESS_SCALE : "Viridis",
    colorbar: { title: { text: `${answer.label} (${scale.unit})`, side: "right", font: style }, tickfont: style, thickness: 14, outlinewidth: 0 }, hovertemplate: `%{x}°, z = %{y:.3~g} m: %{z:.3g} ${scale.unit}<extra></extra>` };
  window.Plotly.react(parts.plot, [trace], layout, SETTINGS);
  parts.plot.setAttribute("role", "img");
  parts.plot.setAttribute("aria-label", `${capital(answer.label)} of the ${answer.name} over angle and axial position at ${parts.time.textContent}, colours to ${show(answer.limit, "Pa", 3)}`);
}

// What is chosen at the curves is shown here too.
export function seek(to) {
  time = to;
  if (shown) picture();
}
