// What can be taken hold of on the section, absorbers and sources: turned about the axis by mouse, finger or arrow keys, one stop of the
// tab key for all of them. Elements stay from one picture to the next, so that neither focus nor a finger loses its hold.
import { turned } from "./building.js";
import { svg } from "./dom.js";
import { show } from "./units.js";

const STEP = 1, LEAP = 10; // degrees
let shown = [], chosen = "", expected = false, held = null, tell = {}, waiting = 0;

// `box` holds the pictures; tell: change(path, angle), add(), remove(key), centre(event) gives the pointer's angle in degrees.
export function setUp(box, told) {
  tell = told;
  box.addEventListener("pointerdown", (event) => {
    const handle = of(event.target);
    if (!handle || event.button) return;
    event.preventDefault();
    choose(handle.key, true);
    held = { key: handle.key, from: tell.angle(event), start: handle.value };
    box.setPointerCapture(event.pointerId);
  });
  box.addEventListener("pointermove", (event) => {
    const handle = held && shown.find(({ key }) => key === held.key);
    if (!handle) return;
    held.to = turned(Math.round(held.start + tell.angle(event) - held.from));
    waiting ||= requestAnimationFrame(() => { waiting = 0; if (held) turn(handle, held.to); });
  });
  const release = () => { held = null; };
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) box.addEventListener(name, release);
  box.addEventListener("keydown", (event) => {
    const handle = of(event.target), number = shown.indexOf(handle), step = event.shiftKey ? LEAP : STEP;
    if (!handle || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = {
      ArrowRight: () => turn(handle, turned(handle.value + step)),
      ArrowLeft: () => turn(handle, turned(handle.value - step)),
      ArrowDown: () => choose(shown[(number + 1) % shown.length].key, true),
      ArrowUp: () => choose(shown.at(number - 1).key, true),
      Delete: () => tell.remove(handle.key),
      Insert: () => tell.add(),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

const of = (target) => shown.find(({ key }) => key === target.closest?.("[data-handle]")?.dataset.handle);
const turn = (handle, angle) => { if (angle !== handle.value) tell.change(handle.path, angle); };

export const choice = () => chosen;

// The next picture has this one, which is chosen there, with the focus if one of them has it now.
export function expect(key) {
  [chosen, expected] = [key, shown.some(({ node }) => node === document.activeElement)];
}

// One of them is chosen: it alone is a stop of the tab key, and it is marked.
export function choose(key, focus = false) {
  chosen = key;
  for (const { key: each, node } of shown) {
    node.setAttribute("tabindex", each === key ? 0 : -1);
    node.classList.toggle("chosen", each === key);
    if (focus && each === key) node.focus({ preventScroll: true });
  }
  tell.chosen?.();
}

// Bring the elements in a layer of the picture up to date: wanted are { key, path, value, label, parts }.
export function place(layer, wanted) {
  const nodes = new Map([...layer.children].map((node) => [node.dataset.handle, node]));
  shown = wanted.map((handle) => ({ ...handle, node: nodes.get(handle.key) ?? svg("g", { "data-handle": handle.key, class: "handle", role: "slider", "aria-valuemin": -180, "aria-valuemax": 180 }) }));
  for (const { node, label, value, parts } of shown) {
    node.setAttribute("aria-label", label);
    node.setAttribute("aria-valuenow", value);
    node.setAttribute("aria-valuetext", show(value, "deg"));
    node.replaceChildren(...parts);
  }
  const keys = shown.map(({ node }) => node);
  if (keys.length !== layer.children.length || keys.some((node, i) => node !== layer.children[i])) {
    const focused = keys.includes(document.activeElement) ? document.activeElement : null;
    layer.replaceChildren(...keys);
    focused?.focus({ preventScroll: true });
  }
  if (!shown.some(({ key }) => key === chosen)) chosen = (shown.find(({ key }) => key.startsWith("absorbers")) ?? shown[0])?.key ?? "";
  choose(chosen, expected);
  expected = false;
}
