// The wave in three dimensions: which cut is shown, what pictures and energy cost before they are begun, and the walls along the axis.
import { request } from "./api.js";
import { offer } from "./panel.js";
import { placeText } from "./space.js";
import { stressColour } from "./maps.js";

export const FRAMES = 100, SIZE = 160, HALF_WIDTH = 3; // of the pictures of a cut
let known = { run: "", costs: null };

export const every = (answer, frames) => Math.max(1, Math.ceil(answer.arrays.time.values.length / frames));

// What cuts and energy of a run cost.
export async function costsOf(answer) {
  if (known.run !== answer.run) known = { run: answer.run, costs: request(`/api/runs/${answer.run}/costs?every=${every(answer, FRAMES)}&size=${SIZE}&half_width=${HALF_WIDTH}`) };
  const mine = known;
  return mine.costs.catch((failure) => { if (mine === known) known = { run: "", costs: null }; throw failure; });
}

export const inTime = (seconds) => (seconds < 90 ? `${Number(seconds.toPrecision(2))}\u202fs` : `${Number((seconds / 60).toPrecision(2))}\u202fmin`);

// The cuts of a run in a select: along the axis, or across it at a station; gives the one that is chosen.
export function chosen(select, stations) {
  return offer(select, [["along", "along the axis, y = 0"], ...stations.map((z, i) => [`across/${i}`, `across, ${placeText(z)}`])], select.value);
}

// A cut as a job knows it, and in words.
export const asked = (cut) => { const [plane, station = 0] = cut.split("/"); return { plane, station: Number(station) }; };
export const told = ({ plane, station }) => (plane === "along" ? " along the axis" : plane ? ` across, ${placeText(station)}` : "");

// Walls at head and tail of each shell: dark lines, coloured by their stress as far as stations go.
export function walls(context, one, frame, limit, pixels) {
  const toPixels = pixels / (2 * one.half_width), [first, count] = one.rows, row = pixels / one.size;
  one.sides.forEach(({ from, to }, i) => {
    const x = pixels / 2 + 0.5 * (from + to) * toPixels, stress = one.rings.get(i);
    context.fillStyle = "rgb(60 60 60)";
    context.fillRect(x - (stress ? 3.5 : 2), 0, stress ? 7 : 4, pixels);
    for (let k = 0; stress && k < count; k += 1) {
      context.fillStyle = stressColour(stress[frame * count + k] / limit.stress);
      const [top, foot] = [k + 1, k].map((place) => Math.round(pixels - (first + place) * row));
      context.fillRect(x - 2.5, top, 5, foot - top);
    }
  });
}
