// Sliders: which entries have one, between what, and how the handle's way maps to the value.
const STEPS = 400;

const RANGES = [
  [/absorbers(\[\d+\])?\.mass$/, { kind: "log", low: 0.1, high: 1000 }],
  [/absorbers(\[\d+\])?\.damping$/, { kind: "log", low: 1e3, high: 1e8, zero: true }],
  [/absorbers(\[\d+\])?\.linear_stiffness$/, { kind: "log", low: 1e6, high: 1e12, zero: true }],
  [/absorbers(\[\d+\])?\.cubic_stiffness$/, { kind: "log", low: 1e14, high: 1e24, zero: true }],
  [/absorbers\.count$/, { kind: "linear", low: 0, high: 60, steps: 60 }],
  [/absorbers(\[\d+\])?\.(offset|angle)$/, { kind: "linear", low: -180, high: 180, steps: 360 }],
  [/control(\[\d+\])?\.proportional$/, { kind: "signed", low: 1, high: 1e6 }],
  [/control(\[\d+\])?\.derivative$/, { kind: "signed", low: 0.1, high: 1e4 }],
  [/source(\[\d+\])?\.angle$/, { kind: "linear", low: -180, high: 180, steps: 360 }],
  [/source(\[\d+\])?\.(pulse\.)?peak_pressure$/, { kind: "log", low: 1e3, high: 1e8 }],
];

export function rangeOf(path) {
  return RANGES.find(([pattern]) => pattern.test(path))?.[1] ?? null;
}

export const steps = (range) => range.steps ?? STEPS;

function rounded(value) { return Number(value.toPrecision(3)); }

// Handle 0 ... steps to value. A signed range is logarithmic on both sides of 0.
export function valueAt(range, handle) {
  const part = handle / steps(range);
  if (range.kind === "linear") return Math.round(range.low + part * (range.high - range.low));
  const grow = (share) => rounded(range.low * (range.high / range.low) ** share);
  if (range.kind === "log") return range.zero && handle === 0 ? 0 : grow(part);
  const side = 2 * part - 1;
  return Math.abs(side) < 1e-9 ? 0 : Math.sign(side) * grow(Math.abs(side));
}

export function handleAt(range, value) {
  const share = (size) => Math.log(size / range.low) / Math.log(range.high / range.low);
  let part;
  if (range.kind === "linear") part = (value - range.low) / (range.high - range.low);
  else if (range.kind === "log") part = value <= 0 ? 0 : share(value);
  else part = value === 0 ? 0.5 : 0.5 + 0.5 * Math.sign(value) * Math.max(share(Math.abs(value)), 1 / steps(range));
  return Math.round(Math.min(1, Math.max(0, part)) * steps(range));
}

// Between what a study may vary a field that has a value now: a decade to either side, a gain up to twice itself, else a quarter.
export function span(path, value, electrodes = false) {
  const range = rangeOf(path.replace("[*]", ""));
  if (range?.kind === "linear") return { from: range.low, to: range.high, scale: "linear" };
  if (range?.kind === "signed") return value ? { from: Math.min(2 * value, 0), to: Math.max(2 * value, 0), scale: "linear" } : electrodes ? { from: 0, to: 10, scale: "linear" } : { from: -range.high / 10, to: 0, scale: "linear" };
  if (range?.kind === "log") return value > 0 ? { from: Math.max(range.low, rounded(value / 10)), to: Math.min(range.high, rounded(10 * value)), scale: "log" } : { from: range.low, to: range.high, scale: "log" };
  return value ? { from: rounded(Math.min(0.75 * value, 1.25 * value)), to: rounded(Math.max(0.75 * value, 1.25 * value)), scale: "linear" } : { from: 0, to: 1, scale: "linear" };
}
