// Control laws in the form: one for all shells, or several, each for shells of its own.
import { el } from "./dom.js";
import { numeral, show } from "./units.js";
import { capital, shellName } from "./words.js";

const ENDS = { inner: () => 0, outer: (count) => count - 1, middle: (count) => (count === 3 ? 1 : -1) };
const GAINS = ["proportional", "derivative"];

// Shells that have layers which sense or drive, by number.
export const controllable = (shells) => shells.flatMap(({ layers }, i) => (layers?.some(({ role }) => ["sensor", "actuator", "self-sensing"].includes(role)) ? [i] : []));

// The numbers of a law's shells, in the order in which they are named; null where it is not one of the form's.
export function numbers(law, count) {
  if (law.shells === undefined || law.shells === "all") return Array.from({ length: count }, (_, i) => i);
  return [law.shells].flat().map((one) => ENDS[one]?.(count) ?? one);
}

// Shells that could have a law and are under none of these.
export function free(laws, shells) {
  const taken = laws.flatMap((law) => numbers(law, shells.length));
  return controllable(shells).filter((i) => !taken.includes(i));
}

// One law for each shell in the place of one for all: each keeps its shell's own gains, and shells without one are given the same.
export function split(law, shells) {
  const own = numbers(law, shells.length), all = [...new Set([...own.filter((i) => i < shells.length), ...controllable(shells)])].sort((a, b) => a - b);
  const place = (shell) => Math.max(own.indexOf(shell), 0), itself = ({ matrix }, shell) => matrix[place(shell)]?.[place(shell)] ?? 1;
  const gain = (name, shell) => (Array.isArray(law[name]) ? law[name][place(shell)] : law[name]);
  const alone = (shell) => (law.matrix ? { matrix: null, numerator: [law.numerator].flat().map((one) => one * itself(law, shell)) } : {}); // each reads itself alone
  return all.map((shell) => ({ ...structuredClone(law), ...Object.fromEntries(GAINS.filter((name) => name in law).map((name) => [name, gain(name, shell)])), ...alone(shell), shells: [shell] }));
}

// What a law of one kind begins with that another kind was before: the same gains, numerator [k_d a/c, k_p] with s in 1/s.
export function turned(law, { shells, fluids }) {
  const transit = shells.at(-1).radius / fluids.at(-1).sound_speed, exact = (value) => Number(value.toPrecision(8));
  if ("derivative" in law) { const [k, d] = GAINS.map((name) => [law[name]].flat()[0]); return { numerator: d ? [exact(d * transit), k] : [k] }; }
  if (!("numerator" in law)) return {};
  const [constant, slope = 0] = [law.numerator].flat().reverse(), divisor = [law.denominator ?? 1].flat().at(-1) || 1;
  return { proportional: exact(constant / divisor), derivative: exact(slope / divisor / transit) };
}

// A further law is like another one, for the first shell that has none.
export function following(law, all, shells) {
  const own = Object.fromEntries(GAINS.filter((name) => Array.isArray(law[name])).map((name) => [name, law[name][0]]));
  return { ...law, ...own, ...(law.matrix ? { matrix: null } : {}), shells: free(all, shells).slice(0, 1) };
}

// All walls are cut alike: what one law says of its segments goes for all. Gives path and value of the change.
export function together(path, value, control) {
  const [, name] = path.match(/^control\[\d+\]\.(segments|dead|dead_belts|dead_electrodes|segment_pitch|segment_length)$/) ?? [];
  return name && Array.isArray(control) ? ["control", control.map((law) => ({ ...law, [name]: value }))] : [path, value];
}

// One line for a closed group: which shells, with what.
export function digest(law, shells) {
  const gain = (value) => [value].flat().map((one) => show(Number(one), "", 3)).join(" / ");
  const what = "numerator" in law ? `H(s) of degree ${[law.numerator].flat().length - 1} over ${[law.denominator ?? 1].flat().length - 1}` : `gains ${GAINS.map((name) => gain(law[name])).join(", ")}`;
  return law.shells === undefined || law.shells === "all" || shells === 1 ? what : `${numbers(law, shells).map((i) => shellName(i, shells)).join(", ")}: ${what}`;
}

// Ticks for the shells of a law: all of them are "all".
export function shellBoxes(path, value, shells, change) {
  const count = shells.length, ticked = new Set(numbers({ shells: value }, count));
  const told = (chosen) => (chosen.length === count ? "all" : chosen);
  const box = (i) => el("label", {}, el("input", { type: "checkbox", "data-path": `${path}[${i}]`, checked: ticked.has(i), onchange: ({ target }) => {
    if (target.checked) ticked.add(i); else ticked.delete(i);
    change(path, told([...ticked].sort((a, b) => a - b)));
  } }), ` ${capital(shellName(i, count))}`);
  return el("fieldset", { class: "ticks", "data-group": path }, el("legend", {}, "For"), ...shells.map((_, i) => box(i)));
}

// A gain as it was typed: one number, or several with commas between, one for each shell.
export const gains = (text) => (text.includes(",") ? text.split(",").map((part) => numeral(part)) : numeral(text));
export const isGain = (path) => /^control(\[\d+\])?\.(proportional|derivative)$/.test(path);
