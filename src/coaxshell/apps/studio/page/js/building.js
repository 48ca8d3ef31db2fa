// Building a system: shells put in, taken out and exchanged, with what hangs on their places: fluids, absorbers, control.
// Region i lies inside shell i, region i + 1 outside it; an absorber of inner_shell i holds the shells i and, unless outer_shell says another, i + 1.
const rounded = (value) => Number(value.toPrecision(4));

// A copy of a shell outside it: halfway to the next one, or a quarter larger. The region that it divides is there twice.
export function withShellAfter(system, index) {
  const { shells } = system, [shell, next] = [shells[index], shells[index + 1]], last = !next;
  const copy = { ...structuredClone(shell), radius: rounded(last ? 1.25 * shell.radius : (shell.radius + next.radius) / 2) };
  const gap = structuredClone(system.fluids[last && index > 0 ? index : index + 1]);
  return {
    ...system,
    shells: [...shells.slice(0, index + 1), copy, ...shells.slice(index + 1)],
    fluids: [...system.fluids.slice(0, index + 1), gap, ...system.fluids.slice(index + 1)],
    absorbers: onPairs(system.absorbers, (number) => (number > index ? number + 1 : number)),
    control: onShells(system.control, (number) => (number > index ? number + 1 : number)),
  };
}

// Without a shell, the absorbers that it held and, of the two regions that become one, the gap.
export function withoutShell(system, index) {
  const shells = system.shells.filter((_, i) => i !== index), gone = index === system.shells.length - 1 ? index : index + 1;
  const control = onShells(system.control, (number) => (number === index ? null : number > index ? number - 1 : number));
  const senses = shells.some((shell) => shell.layers?.some(({ role }) => ["sensor", "actuator", "self-sensing"].includes(role)));
  return {
    ...system,
    shells,
    fluids: system.fluids.filter((_, i) => i !== gone),
    absorbers: onPairs(system.absorbers, (number) => (number === index ? null : number > index ? number - 1 : number)),
    control: senses ? control : null,
  };
}

// The walls of a shell and the next one out change places; the radii stay, so that all still lie one inside the other.
export function withWallsExchanged(system, index) {
  const shells = [...system.shells], [inner, outer] = [shells[index], shells[index + 1]];
  shells[index] = { ...outer, radius: inner.radius };
  shells[index + 1] = { ...inner, radius: outer.radius };
  return { ...system, shells };
}

// The shells that an absorber links, the inner one first.
export const linkedShells = ({ inner_shell, outer_shell }) => [inner_shell ?? 0, outer_shell ?? (inner_shell ?? 0) + 1];

// An absorber between other shells; that the outer one is the next one out goes without saying.
export function between({ outer_shell: _, ...one }, inner, outer) {
  return { ...one, inner_shell: inner, ...(outer > inner + 1 ? { outer_shell: outer } : {}) };
}

// Where an absorber is drawn: the shells between which it runs, and the gap in which its mass is, the outermost that it is in.
export function reach(absorber) {
  const [inner, outer] = linkedShells(absorber), { links = "both", grounded = false } = absorber;
  return { inner, outer, gap: links === "inner" && !grounded ? inner : outer - 1 };
}

// Absorbers with the numbers of their shells mapped; those of a shell that is no more (null) are left out, neighbours stay neighbours.
function onPairs(absorbers, to) {
  const moved = (one) => {
    const [inner, outer] = linkedShells(one), [first, last] = [to(inner), to(outer)];
    return first === null || last === null ? [] : [between(one, first, outer > inner + 1 ? last : first + 1)];
  };
  return Array.isArray(absorbers) ? absorbers.flatMap(moved) : absorbers ? moved(absorbers)[0] ?? [] : absorbers;
}

// Control, or each of several laws, with the numbers of its shells mapped; names such as "inner", and "all", mean what is there.
function onShells(control, to) {
  if (Array.isArray(control)) {
    const laws = control.map((law) => onShells(law, to)).filter((law) => law !== null);
    return laws.length > 1 ? laws : laws[0] ?? null;
  }
  if (!Array.isArray(control?.shells)) return control;
  const shells = control.shells.map((one) => (typeof one === "number" ? to(one) : one)).filter((one) => one !== null);
  return shells.length ? { ...control, shells } : null;
}

// Of a ring its absorbers one by one.
export function singly(ring, more = {}) {
  if (!("count" in ring)) return [ring];
  const { count, offset = 0, ...shared } = ring;
  return Array.from({ length: count }, (_, k) => ({ ...shared, ...more, angle: turned(offset + (360 * k) / count) }));
}

// An angle within (-180, 180], without the digits of rounding.
export const turned = (angle) => Number((180 - ((((180 - angle) % 360) + 360) % 360)).toPrecision(8));

// The middle of the largest arc without an absorber in a gap that one like this is in.
export function freeAngle(absorbers, like) {
  const [inner, outer] = linkedShells(like), beside = (one) => { const [a, b] = linkedShells(one); return a < outer && b > inner; };
  const angles = absorbers.filter(beside).map(({ angle = 0 }) => turned(angle)).sort((a, b) => a - b);
  if (!angles.length) return 0;
  const arcs = angles.map((angle, i) => (i + 1 < angles.length ? angles[i + 1] : angles[0] + 360) - angle), widest = arcs.indexOf(Math.max(...arcs));
  return turned(Math.round(angles[widest] + arcs[widest] / 2));
}
