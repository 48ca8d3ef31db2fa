// A measured pressure record: opened or pasted, its columns and units chosen, and what was understood drawn small with its numbers.
import { request } from "./api.js";
import { el, svg } from "./dom.js";
import { show } from "./units.js";
import { capital, told } from "./words.js";

const WIDTH = 300, HEIGHT = 96;
const UNITS = { time: ["s", "ms", "us"], pressure: ["Pa", "kPa", "MPa", "bar", "psi"] };
const given = new Map(); // by path: what a person gave last, { text or file, name, options }
let views = [];

// Keep what the library understood of the records of a description.
export function understood(answers) { views = answers ?? []; }

// The part of a form that stands for the two columns of samples of the pulse at `path`; change(path, pulse) adopts new ones.
export function editor(path, change) {
  const box = el("div", { class: "record", "data-record": path });
  const note = el("p", { class: "note", role: "status" });
  const input = el("input", { type: "file", hidden: true, accept: ".csv,.txt,.dat,.tsv,.asc,.mat,.wav", "aria-label": "A file with a pressure record", onchange: () => { const [file] = input.files; input.value = ""; if (file) give({ body: file, name: file.name, options: {} }); } });
  const pasted = el("textarea", { rows: 4, spellcheck: "false", "aria-label": "Columns of time and pressure", placeholder: "time (ms), pressure (kPa)\n0, 0\n0.01, 24.8\n0.02, 22.9" });
  const choices = el("div", { class: "record-choices" });

  async function give(one) {
    given.set(path, one);
    note.textContent = "Reading…";
    note.classList.remove("problem");
    try {
      const query = new URLSearchParams(Object.entries({ name: one.name, ...one.options }).filter(([, value]) => value !== "")).toString();
      const answer = await request(`/api/record?${query}`, { body: one.body, type: "application/octet-stream" });
      if (given.get(path) !== one) return null; // something newer was given meanwhile
      one.columns = answer.columns;
      if (answer.ok) return change(path, answer.pulse);
      note.textContent = `Not read. ${told(answer.problem)}`;
      note.classList.add("problem");
      offer();
    } catch (failure) { note.textContent = `Not read. ${told(failure)}`; note.classList.add("problem"); }
    return null;
  }

  // Columns and units to choose, once something was given.
  function offer() {
    const one = given.get(path), columns = one?.columns ?? [];
    if (!one) return;
    const pick = (name, label, values) => {
      const id = `record-${path}-${name}`;
      const select = el("select", { id, onchange: () => { const now = given.get(path); give({ ...now, options: { ...now.options, [name]: select.value } }); } },
        el("option", { value: "" }, name.endsWith("unit") ? "as written" : "found by itself"), ...values.map((value) => el("option", { value, selected: value === one.options[name] }, value)));
      return el("div", { class: "field" }, el("label", { for: id }, label), select);
    };
    choices.replaceChildren(...(columns.length > 1 ? [pick("time_column", "Column of time", columns), pick("pressure_column", "Column of pressure", columns)] : []),
      pick("time_unit", "Unit of time", UNITS.time), pick("pressure_unit", "Unit of pressure", UNITS.pressure));
  }

  const view = views.find((one) => one.path === path);
  box.append(...(view ? [picture(view), el("p", { class: "note" }, numbers(view)), ...view.remarks.map((text) => el("p", { class: "note remark" }, capital(text)))] : []),
    el("div", { class: "buttons" }, el("button", { type: "button", onclick: () => input.click() }, "Open record…"), input),
    el("details", { class: "paste" }, el("summary", {}, "Paste or type a record"), el("div", { class: "body" }, pasted,
      el("div", { class: "buttons" }, el("button", { type: "button", onclick: () => give({ body: new Blob([pasted.value]), name: "pasted.csv", options: {} }) }, "Read")))), choices, note);
  offer();
  return box;
}

function numbers({ recorded, samples, duration, peak, peak_time, decay_time, impulse }) {
  const count = (number) => number.toLocaleString("en");
  return `${count(samples)} samples over ${show(duration, "s")}${recorded === samples ? "" : ` of ${count(recorded)} recorded`}; peak ${show(peak, "Pa")} at ${show(peak_time, "s")}, `
    + `${decay_time === null ? "not down to 1/e of it at the end" : `1/e of it ${show(decay_time, "s")} later`}, impulse ${show(impulse, "Pa*s")}.`;
}

function picture({ time, pressure, peak }) {
  const low = Math.min(0, ...pressure), high = Math.max(0, ...pressure), span = high - low || 1, last = time.at(-1) || 1;
  const x = (value) => (4 + (value / last) * (WIDTH - 8)).toFixed(1), y = (value) => (4 + ((high - value) / span) * (HEIGHT - 8)).toFixed(1);
  return svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `Pressure over time, peak ${show(peak, "Pa")}` },
    svg("line", { x1: 4, x2: WIDTH - 4, y1: y(0), y2: y(0), stroke: "var(--line)" }),
    svg("path", { d: `M${time.map((value, i) => `${x(value)} ${y(pressure[i])}`).join("L")}`, fill: "none", stroke: "var(--current)", "stroke-width": 1.4, "stroke-linejoin": "round" }));
}
