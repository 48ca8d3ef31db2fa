// The first minute: what to do, one thing after another, each gone on from as soon as it is done; shown to who comes for the first time.
import { by, el } from "./dom.js";

const SEEN = "coaxshell-guided";
const STEPS = [
  ["Pull the slider Count under Absorbers, or turn the ring on the section: blue is the system, dashed grey the same without absorbers and control.", (now, then) => JSON.stringify(now.system.absorbers) !== JSON.stringify(then.system.absorbers)],
  ["Press Pin above the curves: this run stays, in orange, whatever you change next.", (now) => Boolean(now.runs.pinned)],
  ["Open Wave below the curves and press Play: the shock passes over all of them side by side.", (now) => now.tab === "wave"],
  ["Open Designs and keep this one under a name: all that you keep are compared there.", (now) => now.designs > 0],
  ["Download takes home the run, its figures, a report. The address of the page always holds the whole system; Undo takes back anything.", () => false],
];
let page = () => ({}), step = -1, then = null;

export function setUp(state) {
  page = state;
  by("guide").append(el("span", { id: "guide-count", class: "note" }), el("p", { id: "guide-text", role: "status" }),
    el("button", { type: "button", class: "quiet", id: "guide-next", onclick: () => go(step + 1) }, "Next"), el("button", { type: "button", class: "quiet", id: "guide-close", onclick: close }, "Close"));
  by("first-minute").addEventListener("click", () => (step < 0 ? go(0) : close()));
}

// For who comes for the first time.
export function begin() {
  let seen = true;
  try { seen = localStorage.getItem(SEEN) !== null; } catch { /* private windows may refuse: then nobody can be known again */ }
  if (!seen) go(0);
}

function go(next) {
  if (next >= STEPS.length) return close();
  step = next;
  then = { system: page().system };
  by("guide").hidden = false;
  by("first-minute").setAttribute("aria-expanded", "true");
  by("guide-count").textContent = `${step + 1} of ${STEPS.length}`;
  by("guide-next").textContent = step + 1 < STEPS.length ? "Next" : "Done";
  by("guide-text").textContent = STEPS[step][0];
  return null;
}

function close() {
  step = -1;
  by("guide").hidden = true;
  by("first-minute").setAttribute("aria-expanded", "false");
  try { localStorage.setItem(SEEN, "yes"); } catch { /* as above */ }
}

// Whether the present step is done.
export function look() {
  if (step >= 0 && STEPS[step][1](page(), then)) go(step + 1);
}
