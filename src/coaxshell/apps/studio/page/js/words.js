// The page's own words: names of shells, of fields by their paths, and the library's remedies as things to do here.
import { split } from "./paths.js";

// Of shells and fluids, counted from 0 inside: the names of the library's model/places.py, kept the same by a test.
export function shellName(index, count) {
  if (count === 1) return "shell";
  if (index === 0) return "inner";
  if (index === count - 1) return "outer";
  return count === 3 ? "middle" : `shell ${index + 1} of ${count}`;
}

export function shellPhrase(index, count) {
  const name = shellName(index, count);
  return name.startsWith("shell") ? name : `${name} shell`;
}

export function regionSide(number, shells) {
  return number === 0 ? "inside" : number === shells ? "outside" : shells === 2 ? "gap" : `gap ${number}`;
}

export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

const FIELDS = {
  proportional: "Proportional gain (V/V)", derivative: "Derivative gain (V per V/transit)", inner_shell: "Between", z: "Axial position z", dimensions: "Dimensions", stations: "Stations z (m)", axial_modes: "Axial wavenumbers (1/a)", axial_period: "Axial period", duration: "Duration (a/c)", time_step: "Time step (a/c)", modes: "Orders",
  youngs_modulus: "Young’s modulus", poisson_ratio: "Poisson’s ratio",
};

// What a field is called: words with a capital, but symbols such as c22 and e32 as they are.
export function title(name) {
  if (name in FIELDS) return FIELDS[name];
  const words = name.replace(/_/g, " ");
  return /^[a-z]{1,3}\d\d$/.test(name) ? words : capital(words);
}

// A dotted path for people: "inner shell, layer 2, thickness".
export function placeName(path, shells) {
  const parts = split(path), words = [];
  parts.forEach((part, i) => {
    const before = parts[i - 1];
    if (typeof part !== "number") {
      if (typeof parts[i + 1] === "number" && /^(shells|fluids|layers|absorbers|source|control)$/.test(part)) return;
      words.push(title(part).replace(/ \(.*\)$/, "").replace(/^[A-Z](?=[a-z])(?!oung|oisson)/, (c) => c.toLowerCase()));
    } else if (before === "shells") words.push(shellPhrase(part, shells));
    else if (before === "fluids") words.push(`fluid ${regionSide(part, shells)}`);
    else if (before === "control") words.push(`law ${part + 1}`);
    else words.push(`${String(before ?? "item").replace(/s$/, "")} ${part + 1}`);
  });
  return words.join(", ");
}

// Whatever went wrong (a failed request, a failed job, a problem with the description), as texts.
export function refusal(error) {
  const found = error?.problem && typeof error.problem === "object" ? error.problem : error ?? {};
  const text = (value) => (typeof value === "string" ? value : "");
  return { where: text(found.where), problem: text(found.problem) || text(found.message) || "it failed without a reason", remedy: text(found.remedy) };
}

// The same as one line; the library's remedies name Python's and the scenario's entries, which are ticks and fields here.
export function told(error) {
  const { where, problem, remedy } = refusal(error);
  return [where, inWords([problem, remedy].filter(Boolean).join("; "))].filter(Boolean).join(": ");
}

export function inWords(text) {
  return text
    .replace(/\bset ([\w.[\]]+) ?= ?(true|false)\b/g, (_, path, value) => `${value === "true" ? "tick" : "untick"} ${title(path.split(".").at(-1))}`)
    .replace(/\buse axial_modes ?= ?([\d.e]+) or modes ?= ?"auto"/g, "set Axial wavenumbers to $1 under Dimensions")
    .replace(/\buse dimensions ?= ?([23])/g, (_, number) => `choose ${number === "2" ? "two" : "three"} under Dimensions`)
    .replace(/\buse modes ?= ?(\d+) or modes ?= ?"auto"/g, "set Orders to $1 under Resolution")
    .replace(/\bmodes ?= ?(\d+)/g, "Orders $1")
    .replace(/\btime_step ?= ?([\d.e-]+)/g, "a time step of $1 a/c")
    .replace(/\bgive (time|pressure)_column, a name or a number from 1 on/g, "choose the column of $1")
    .replace(/\bgive (time|pressure)_unit\b/g, "choose the unit of $1")
    .replace(/\b(wetted|theory|transducers) ?= ?"([\w-]+)"/g, (_, name, value) => `${title(name)} “${value}”`)
    .replace(/\brefinement ?= ?(\d+)/g, "Refinement $1")
    .replace(/\bhalve time_step\b/g, "halve the time step under Resolution");
}
