// The cross-section to scale, with absorbers, the source's direction and its front.
import { el, svg, by } from "./dom.js";
import { show } from "./units.js";

const SIZE = { width: 320, height: 190, radius: 72, x: 118, y: 95 };

export function draw(system) {
  const shells = system.shells.filter((shell) => Number(shell.radius) > 0);
  if (!shells.length) return;
  const outer = Math.max(...shells.map((shell) => shell.radius)), scale = SIZE.radius / outer;
  const picture = svg("svg", { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "img", "aria-label": words(system) });
  const scene = svg("g", zoom(system.sea, outer));
  picture.append(scene);
  shells.slice().reverse().forEach((shell) => {
    const wall = (shell.layers ?? []).reduce((sum, layer) => sum + Number(layer.thickness || 0), 0);
    scene.append(svg("circle", { cx: SIZE.x, cy: SIZE.y, r: shell.radius * scale, fill: "var(--accent-soft)", "fill-opacity": 0.55, stroke: shell.rigid ? "var(--text)" : "var(--current)", "stroke-width": Math.max(wall * scale, shell.rigid ? 2.5 : 1.4) }));
  });
  scene.append(...planes(system.sea, scale));
  const sources = Array.isArray(system.source) ? system.source : [system.source];
  scene.append(...absorbers(system, shells, scale), ...sources.flatMap((source) => shock(source, outer, scale)));
  by("section").replaceChildren(picture, el("figcaption", {}, caption(system, outer)));
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
  const { count = 0, offset = 0, inner_shell = 0 } = system.absorbers;
  return Array.from({ length: Math.min(count, 400) }, (_, k) => ({ angle: offset + (360 * k) / count, inner_shell }));
}

function absorbers(system, shells, scale) {
  return placed(system).flatMap(({ angle = 0, inner_shell = 0 }) => {
    if (!shells[inner_shell + 1]) return [];
    const ends = [shells[inner_shell].radius * scale, shells[inner_shell + 1].radius * scale];
    const [x1, y1] = point(ends[0], angle), [x2, y2] = point(ends[1], angle), [x, y] = point((ends[0] + ends[1]) / 2, angle);
    return [svg("line", { x1, y1, x2, y2, stroke: "var(--muted)", "stroke-width": 0.9 }), svg("circle", { cx: x, cy: y, r: 2.1, fill: "var(--pinned)" })];
  });
}

// The front where it touches the outermost shell, curved as it is, and an arrow the way it goes.
function shock(source, outer, scale) {
  const angle = Number(source.angle) || 0;
  const distance = source.distance ?? (source.stand_off ? source.stand_off + outer : null);
  const parts = [0, 9, 18].map((behind, i) => front(angle, distance, outer, scale, behind, 1 - 0.35 * i));
  const [x1, y1] = point(SIZE.radius + 62, angle), [x2, y2] = point(SIZE.radius + 26, angle);
  parts.push(svg("path", { d: `M${x1} ${y1}L${x2} ${y2}`, stroke: "var(--pinned)", "stroke-width": 1.8 }), head(x2, y2, angle));
  return parts;
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

function caption(system, outer) {
  const source = Array.isArray(system.source) ? system.source[0] : system.source;
  const distance = source.distance ?? (source.stand_off ? source.stand_off + outer : null);
  return `outermost radius ${show(outer, "m")}, source ${distance ? `at ${show(distance, "m")}` : "far away"} (${show(Number(source.angle) || 0, "deg")})${system.sea ? `, surface ${show(Number(system.sea.depth), "m")} above` : ""}`;
}

function words(system) {
  const number = placed(system).length;
  return `Cross-section to scale: ${system.shells.length} shell${system.shells.length > 1 ? "s" : ""} of radius ${system.shells.map((shell) => show(shell.radius, "m")).join(" and ")}, ${number} absorber${number === 1 ? "" : "s"}; ${caption(system, Math.max(...system.shells.map((s) => s.radius)))}`;
}
