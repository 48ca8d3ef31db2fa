// The cross-section to scale, with absorbers, the source's direction and its front.
import { reach, turned } from "./building.js";
import { el, svg, by } from "./dom.js";
import * as handles from "./handles.js";
import { show } from "./units.js";

const SIZE = { width: 320, height: 190, radius: 72, x: 118, y: 95 };

let parts = null, system = null, tell = {};

// tell: change(path, value, { live }) => void, and what the buttons beneath do: add(), remove(key), singly().
export function setUp(told) {
  tell = told;
  const button = (text, onclick) => el("button", { type: "button", onclick }, text);
  parts = {
    scene: svg("g"), layer: svg("g"), picture: svg("svg", { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "group" }), caption: el("figcaption"),
    add: button("Add absorber", () => tell.add()), remove: button("Remove", () => tell.remove(handles.choice())), singly: button("Place one by one", () => tell.singly()),
    hint: el("p", { class: "hint" }, "Drag, or ← → turn (with Shift by 10°), ↑ ↓ choose, Insert adds, Delete removes."),
  };
  parts.picture.append(parts.scene, parts.layer);
  by("section").replaceChildren(parts.picture, parts.caption, el("div", { class: "buttons" }, parts.add, parts.singly, parts.remove), parts.hint);
  handles.setUp(parts.picture, { ...tell, change: (path, value) => tell.change(path, value, { live: true }), angle: pointerAngle, chosen: offer });
}

export function draw(now) {
  system = now;
  const shells = system.shells.filter((shell) => Number(shell.radius) > 0);
  if (!shells.length) return;
  const outer = Math.max(...shells.map((shell) => shell.radius)), scale = SIZE.radius / outer, { transform = null } = zoom(system.sea, outer);
  parts.picture.setAttribute("aria-label", words(system));
  for (const layer of [parts.scene, parts.layer]) if (transform) layer.setAttribute("transform", transform); else layer.removeAttribute("transform");
  parts.scene.replaceChildren(...shells.slice().reverse().map((shell) => {
    const wall = (shell.layers ?? []).reduce((sum, layer) => sum + Number(layer.thickness || 0), 0);
    return svg("circle", { cx: SIZE.x, cy: SIZE.y, r: shell.radius * scale, fill: "var(--accent-soft)", "fill-opacity": 0.55, stroke: shell.rigid ? "var(--text)" : "var(--current)", "stroke-width": Math.max(wall * scale, shell.rigid ? 2.5 : 1.4) });
  }), ...planes(system.sea, scale));
  const single = !Array.isArray(system.source);
  handles.place(parts.layer, [...absorbers(system, shells, scale), ...[system.source].flat().map((source, i) => {
    const path = single ? "source" : `source[${i}]`, value = Number(source.angle) || 0;
    return { key: path, path: `${path}.angle`, value, label: single ? "Source" : `Source ${i + 1}`, parts: shock(source, outer, scale) };
  })]);
  parts.caption.textContent = caption(system, outer);
}

// What the buttons can do with what is chosen.
function offer() {
  const several = Array.isArray(system.absorbers);
  parts.add.hidden = system.shells.length < 2 || !several;
  parts.singly.hidden = several;
  parts.remove.hidden = several && !system.absorbers.length;
  parts.remove.disabled = !handles.choice().startsWith("absorbers");
  parts.remove.textContent = several ? "Remove the chosen one" : "Remove the ring";
  parts.remove.setAttribute("aria-label", several && !parts.remove.disabled ? `Remove absorber ${Number(handles.choice().match(/\d+/)) + 1}` : parts.remove.textContent);
}

// Where a pointer is about the axis of the shells, in degrees.
function pointerAngle(event) {
  const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(parts.layer.getScreenCTM().inverse());
  return (Math.atan2(SIZE.y - at.y, at.x - SIZE.x) * 180) / Math.PI;
}

function point(radius, degrees) {
  const angle = (degrees * Math.PI) / 180;
  return [SIZE.x + radius * Math.cos(angle), SIZE.y - radius * Math.sin(angle)];
}

// Smaller where a plane of the sea is near, so that it is in the picture.
function zoom(sea, outer) {
  const near = [sea?.depth, sea?.bottom].map(Number).filter((far) => far > 0 && far < 4 * outer);
  const factor = Math.min(1, (SIZE.y - 8) / (SIZE.radius * Math.max(1, ...near.map((far) => far / outer))));
  return factor < 1 ? { transform: `translate(${SIZE.x} ${SIZE.y}) scale(${factor.toFixed(3)}) translate(${-SIZE.x} ${-SIZE.y})` } : {};
}

// Surface and bottom of the sea where they are in the picture.
function planes(sea, scale) {
  if (!sea) return [];
  const [up, reach] = [Number(sea.up ?? 90), SIZE.width];
  const at = (length, colour, name) => {
    const far = length * scale, [x, y] = point(far, up), [dx, dy] = [Math.sin((up * Math.PI) / 180) * reach, Math.cos((up * Math.PI) / 180) * reach];
    return Math.abs(far) < reach ? [svg("line", { class: name, x1: x - dx, y1: y - dy, x2: x + dx, y2: y + dy, stroke: colour, "stroke-width": 1.6 })] : [];
  };
  return [...at(Number(sea.depth), "var(--accent)", "surface"), ...(sea.bottom ? at(-Number(sea.bottom), "var(--muted)", "bottom") : [])];
}

export function placed(system) {
  if (!system.absorbers) return [];
  if (Array.isArray(system.absorbers)) return system.absorbers;
  const { count = 0, offset = 0, ...shared } = system.absorbers;
  return Array.from({ length: Math.min(count, 400) }, (_, k) => ({ ...shared, angle: offset + (360 * k) / count }));
}

// A ring turns as one; single absorbers each have a hold of their own.
function absorbers(now, shells, scale) {
  const drawn = placed(now).map((one) => absorber(one, shells, scale));
  if (Array.isArray(now.absorbers)) {
    return drawn.flatMap((nodes, i) => {
      const { angle = 0, z } = now.absorbers[i], value = Number(turned(Number(angle) || 0));
      return nodes.length ? [{ key: `absorbers[${i}]`, path: `absorbers[${i}].angle`, value, label: `Absorber ${i + 1} of ${drawn.length}${z === undefined ? "" : `, z = ${show(Number(z), "m")}`}`, parts: nodes }] : [];
    });
  }
  const nodes = drawn.flat();
  return nodes.length ? [{ key: "absorbers", path: "absorbers.offset", value: turned(Number(now.absorbers.offset) || 0), label: `Ring of ${drawn.length} absorbers`, parts: nodes }] : [];
}

function absorber(one, shells, scale) {
  const { angle = 0, grounded = false } = one, alone = shells.length === 1, links = alone ? "outer" : one.links ?? "both", { inner, outer, gap } = reach(one);
  if (!alone && !shells[outer]) return [];
  const radii = alone ? [0.5, 0.75, 1].map((part) => part * shells[0].radius) : [shells[inner].radius, (shells[gap].radius + shells[gap + 1].radius) / 2, shells[outer].radius];
  const [low, middle, high] = radii.map((radius) => radius * scale);
  const [x1, y1] = point(links === "outer" && !grounded ? middle : low, angle), [x2, y2] = point(links === "inner" && !grounded ? middle : high, angle), [x, y] = point(middle, angle);
  return [svg("circle", { class: "hold", cx: x, cy: y, r: 7 }), svg("line", { x1, y1, x2, y2, stroke: "var(--muted)", "stroke-width": 0.9 }), svg("circle", { class: "mass", cx: x, cy: y, r: 2.1 })];
}

// The front where it touches the outermost shell, curved as it is, and an arrow the way it goes.
function shock(source, outer, scale) {
  const angle = Number(source.angle) || 0;
  const distance = source.distance ?? (source.stand_off ? source.stand_off + outer : null);
  const nodes = [0, 9, 18].map((behind, i) => front(angle, distance, outer, scale, behind, 1 - 0.35 * i));
  const [x1, y1] = point(SIZE.radius + 62, angle), [x2, y2] = point(SIZE.radius + 26, angle);
  const [x, y] = point(SIZE.radius + 44, angle);
  nodes.push(svg("circle", { class: "hold", cx: x, cy: y, r: 18 }), svg("path", { d: `M${x1} ${y1}L${x2} ${y2}`, stroke: "var(--pinned)", "stroke-width": 1.8 }), head(x2, y2, angle));
  return nodes;
}

function front(angle, distance, outer, scale, behind, opacity) {
  const far = distance === null || distance > 60 * outer;
  const radius = far ? 1e5 : Math.max((distance - outer) * scale - behind, 1);
  const [cx, cy] = point(SIZE.radius + behind + radius, angle);
  const half = Math.min(0.9, 44 / radius);
  const at = (turn) => { const a = ((angle + 180) * Math.PI) / 180 + turn; return `${(cx + radius * Math.cos(a)).toFixed(2)} ${(cy - radius * Math.sin(a)).toFixed(2)}`; };
  return svg("path", { d: `M${at(-half)}A${radius} ${radius} 0 0 0 ${at(half)}`, fill: "none", stroke: "var(--pinned)", "stroke-width": 1.8, "stroke-opacity": opacity });
}

function head(x, y, angle) {
  return svg("path", { d: "M0 0L8 -3.6V3.6Z", fill: "var(--pinned)", transform: `translate(${x} ${y}) rotate(${-angle})` });
}

function caption(now, outer) {
  const source = [now.source].flat()[0];
  const distance = source.distance ?? (source.stand_off ? source.stand_off + outer : null);
  return `outermost radius ${show(outer, "m")}, source ${distance ? `at ${show(distance, "m")}` : "far away"} (${show(Number(source.angle) || 0, "deg")})${now.sea ? `, surface ${show(Number(now.sea.depth), "m")} above` : ""}`;
}

function words(system) {
  const number = placed(system).length;
  return `Cross-section to scale: ${system.shells.length} shell${system.shells.length > 1 ? "s" : ""} of radius ${system.shells.map((shell) => show(shell.radius, "m")).join(" and ")}, ${number} absorber${number === 1 ? "" : "s"}; ${caption(system, Math.max(...system.shells.map((s) => s.radius)))}`;
}
