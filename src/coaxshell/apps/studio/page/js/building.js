// Building a system: shells put in, taken out and exchanged, with what hangs on their places: fluids, absorbers, control.
// Region i lies inside shell i, region i + 1 outside it; an absorber of inner_shell i holds the shells i and i + 1.
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
    absorbers: inGaps(system.absorbers, (gapNumber) => (gapNumber > index ? gapNumber + 1 : gapNumber)),
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
    absorbers: inGaps(system.absorbers, (gap) => (gap === index || gap === index - 1 ? null : gap > index ? gap - 1 : gap)),
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

// Absorbers with the numbers of their gaps mapped; those of a gap that is no more (null) are left out.
function inGaps(absorbers, to) {
  const moved = (one) => { const gap = to(one.inner_shell ?? 0); return gap === null ? [] : [{ ...one, inner_shell: gap }]; };
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

// The middle of the largest arc of a gap without an absorber.
export function freeAngle(absorbers, gap) {
  const angles = absorbers.filter(({ inner_shell = 0 }) => inner_shell === gap).map(({ angle = 0 }) => turned(angle)).sort((a, b) => a - b);
  if (!angles.length) return 0;
  const arcs = angles.map((angle, i) => (i + 1 < angles.length ? angles[i + 1] : angles[0] + 360) - angle), widest = arcs.indexOf(Math.max(...arcs));
  return turned(Math.round(angles[widest] + arcs[widest] / 2));
}
