// Three dimensions on the page: whether a system needs them, the resolution of their preview, where they are chosen, which station is shown.
import { by, el } from "./dom.js";
import { show } from "./units.js";

const AXIAL = ["stations", "axial_modes", "axial_period"];

export const spatial = (resolution) => resolution?.dimensions === 3;

// Whether two dimensions would refuse a system: an absorber at a point, a source off the plane.
export function needsSpace({ absorbers, source }) {
  const points = Array.isArray(absorbers) && absorbers.some((one) => "z" in one);
  return points || [source].flat().some((one) => one.z || one.inclination);
}

// A resolution in other dimensions: what the third alone has goes with it, and what was as usual is as usual there.
export function inDimensions(resolution, dimensions, { full, full_spatial }) {
  const [before, after] = dimensions === 3 ? [full, full_spatial] : [full_spatial, full];
  const kept = Object.entries(resolution).filter(([name]) => name !== "dimensions" && !AXIAL.includes(name)).map(([name, value]) => [name, value === before[name] ? after[name] : value]);
  return { ...Object.fromEntries(kept), ...(dimensions === 3 ? { dimensions: 3, stations: resolution.stations ?? [0] } : {}) };
}

// What of a resolution belongs to the third dimension, for its preview: fewer axial wavenumbers, as fewer orders.
export function ofSpace({ stations, axial_modes, axial_period }, { modes }) {
  const some = { dimensions: 3, stations: stations ?? [0], axial_period, axial_modes: axial_modes && Math.min(axial_modes, modes) };
  return Object.fromEntries(Object.entries(some).filter(([, value]) => value !== undefined && value !== null));
}

// One line for the closed group of the form.
export const digest = (resolution) => (spatial(resolution) ? `three, z = ${[resolution.stations ?? 0].flat().slice(0, 4).map(place).join(", ")}${[resolution.stations].flat().length > 4 ? ", …" : ""}` : "two");
const place = (z) => (typeof z === "number" ? String(Number(z.toPrecision(6))).replace("-", "−") : z);
export const placeText = (z) => `z = ${place(z)}\u202fm`;

const about = ({ duration, memory }) => `about ${duration.replace(" ", "\u202f")} and ${show(memory, "B", 2)}`;
export function costText(costs) {
  return costs?.full ? `Full resolution takes ${about(costs.full)}${costs.preview ? `, the preview about ${costs.preview.duration.replace(" ", "\u202f")}` : ""}, on a machine that has nothing else to do.` : "";
}

// The select of stations above the curves: those of the run shown. Gives the station that is shown, in m, or null.
export function stationShown(run, wanted) {
  const stations = run?.stations ?? [], select = by("station");
  by("which-station").hidden = stations.length < 2;
  const text = stations.join();
  if (select.dataset.stations !== text) {
    select.replaceChildren(...stations.map((z) => el("option", { value: z }, placeText(z))));
    select.dataset.stations = text;
  }
  const shown = stations.includes(wanted) ? wanted : stations[0] ?? null;
  if (shown !== null) select.value = shown;
  return shown;
}
