// Numbers for people: engineering prefixes, units, and back to what the server reads.
const PREFIXES = [[1e24, "Y"], [1e21, "Z"], [1e18, "E"], [1e15, "P"], [1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const PLAIN = new Set(["deg", "", "kg/m^3", "kg/m", "C/m^2", "N/m^4", "1", "m/s"]);
const SUPERSCRIPTS = { 2: "²", 3: "³", 4: "⁴" };

// kg/m^3 as kg/m³, deg as °.
export function pretty(unit) {
  if (unit === "deg") return "°";
  return (unit ?? "").replace(/\*\*|\^/g, "^").replace(/\^([234])/g, (_, n) => SUPERSCRIPTS[n]).replace(/\*/g, "·");
}

// A person's text as the server reads it.
export function plain(text) {
  return text.trim().replace(/−/g, "-").replace(/([²³⁴])/g, (s) => "^" + Object.keys(SUPERSCRIPTS).find((n) => SUPERSCRIPTS[n] === s)).replace(/·/g, "*").replace(/\s*°$/, " deg").replace(/\s+/g, " ");
}

// A number where the text is one, else the text as the server reads it.
export function numeral(text) {
  const clean = plain(text);
  return clean !== "" && Number.isFinite(Number(clean)) ? Number(clean) : clean;
}

// The factor and symbol that bring a value near 1 to 1000.
export function prefixed(unit, value) {
  const size = Math.abs(value);
  if (PLAIN.has(unit) || !size || !Number.isFinite(size)) return { factor: 1, unit: pretty(unit) };
  const [factor, symbol] = PREFIXES.find(([f]) => size >= f * 0.9995) ?? PREFIXES.at(-1);
  return { factor, unit: symbol + pretty(unit) };
}

function tidy(number) {
  return number.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "").replace(/e\+?(-?)(\d+)/, "e$1$2").replace(/(\.\d*?)0+e/, "$1e").replace(/\.e/, "e");
}

function digits(value, count) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return tidy(value.toExponential(count - 1));
  return tidy(value.toPrecision(count).includes("e") ? String(Math.round(value)) : value.toPrecision(count));
}

// For reading: "1.08 MPa"; a narrow gap keeps number and unit together.
export function show(value, unit, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const scale = prefixed(unit, value);
  const text = digits(value / scale.factor, count).replace("-", "−");
  return scale.unit === "°" ? `${text}°` : scale.unit ? `${text}\u202f${scale.unit}` : text;
}

// For editing: exact, and read back by the server. Only lengths, times, pressures and the like take a prefix.
export function editable(value, unit) {
  if (typeof value !== "number") return value ?? "";
  const scale = prefixed(unit, value);
  const number = Number((value / scale.factor).toPrecision(12));
  const text = Math.abs(number) >= 1e6 || (number && Math.abs(number) < 1e-4) ? tidy(number.toExponential()) : String(number);
  return scale.unit === "°" ? `${text}°` : scale.unit ? `${text} ${scale.unit}` : text;
}

export function percent(value, reference) {
  if (!reference || !Number.isFinite(value / reference)) return null;
  return 100 * (value / reference - 1);
}

// In the words of the command line: a reduction is no negative number.
export function inComparison(change) {
  if (change === null) return "–";
  const ratio = 1 + change / 100;
  if (ratio >= 2) return `${ratio < 999.5 ? ratio.toPrecision(3) : Math.round(ratio)} times as large`;
  if (Math.abs(change) < 0.05) return "the same";
  return `${change < 0 ? "smaller" : "larger"} by ${Math.abs(change).toFixed(1)}\u202f%`;
}
