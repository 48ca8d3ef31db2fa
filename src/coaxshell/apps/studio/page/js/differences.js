// What tells descriptions apart, entry by entry: materials and fluids by their names, records by their lengths.
import { join } from "./paths.js";
import { show } from "./units.js";
import { placeName } from "./words.js";

const WHOLE = /(^|\.)(material|fluids\[\d+\]|time|pressure|numerator|denominator|weights|matrix|dead|dead_belts|dead_electrodes|proportional|derivative|shells|stations)$/; // told as one
let units = new Map(); // by the name of an entry: its unit on a line and, where there is another, at a point

export function setUp(schema) {
  units = new Map();
  for (const [title, { properties = {} }] of Object.entries(schema.$defs)) {
    for (const [name, part] of Object.entries(properties)) {
      const unit = unitOf(part);
      if (unit && (title === "PointAbsorber" || !units.has(name))) units.set(name, { line: unit, ...units.get(name), ...(title === "PointAbsorber" ? { point: unit } : {}) });
    }
  }
}

const unitOf = ({ unit, anyOf }) => unit ?? anyOf?.map(unitOf).find(Boolean);

// Rows { path, label, values } of all entries in which the designs are not all alike; a value is a text, "" where there is none.
export function differences(designs) {
  const each = designs.map(({ system, resolution }) => new Map([...entries(system), ...entries(resolution, "resolution")]));
  const paths = [...new Set(each.flatMap((one) => [...one.keys()]))], shells = Math.max(...designs.map(({ system }) => system.shells.length));
  return paths.filter((path) => path !== "name" && new Set(each.map((one) => JSON.stringify(one.get(path) ?? null))).size > 1).map((path) => ({
    path, label: placeName(path.replace(/^resolution\./, ""), shells), values: each.map((one, i) => (one.has(path) ? text(path, one.get(path), designs[i].system) : "")),
  }));
}

function entries(value, path = "") {
  if (value === null || value === undefined) return [];
  if (typeof value !== "object" || (path && WHOLE.test(path) && !(path === "shells"))) return [[path, value]];
  if (Array.isArray(value)) return value.flatMap((one, i) => entries(one, join(path, i)));
  return Object.entries(value).flatMap(([name, one]) => entries(one, join(path, name)));
}

function text(path, value, { absorbers }) {
  if (value && typeof value === "object") {
    if (Array.isArray(value)) return value.length > 6 ? `${value.length.toLocaleString("en")} numbers` : value.join(", ");
    return value.name || "own";
  }
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value !== "number") return String(value);
  const known = units.get(path.split(".").at(-1)), point = /^absorbers\[/.test(path) && "z" in (absorbers[0] ?? {});
  return known ? show(value, point ? known.point ?? known.line : known.line, 5) : String(Number(value.toPrecision(6))).replace("-", "−");
}
