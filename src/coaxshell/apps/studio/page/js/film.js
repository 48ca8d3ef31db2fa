// One run's field, from the server to this page: frames as bytes, the shells' stress beside them.
import { client, request } from "./api.js";
import * as cuts from "./cuts.js";
import { ended, unwatch, watch } from "./events.js";

const FRAMES = 160, SIZE = 200, HALF_WIDTH = 3;

// Fetch the film of a run; tell(fraction) while the server computes it. Aborting the signal stops the server too. The colours end at
// `limit` (Pa), those of another film beside it, or at what suits this one. In three dimensions it is that of a cut.
export async function film(answer, signal, tell, limit = null, cut = "") {
  const of = cut ? { ...cuts.asked(cut), every: cuts.every(answer, cuts.FRAMES), size: cuts.SIZE, half_width: cuts.HALF_WIDTH } : { every: cuts.every(answer, FRAMES), size: SIZE, half_width: HALF_WIDTH };
  const started = await request("/api/jobs", { body: { client, kind: "field", run: answer.run, ...of }, signal });
  if (!started.job) throw Object.assign(new Error("not started"), { problem: started.problem });
  await finished(started.job, signal, tell);
  const about = await request(`/api/jobs/${started.job.id}/result`, { signal });
  const size = about.size ** 2, pressure = new Uint8Array(about.frames * size), rings = new Map();
  const most = Math.max(1, Math.floor(about.most_values / size));
  const ends = limit ?? about.pressure_limit, asked = limit === null ? "" : `&limit=${limit}`;
  let scale = 1;
  for (let start = 0; start < about.frames; start += most) {
    const part = await request(`/api/jobs/${started.job.id}/frames?start=${start}&count=${most}&format=uint8${asked}`, { signal });
    pressure.set(part.arrays.pressure.values, start * size);
    scale = part.arrays.pressure.scale;
    for (const [name, array] of Object.entries(part.arrays)) {
      if (!name.startsWith("stress/")) continue;
      const shell = Number(name.slice(7)), places = array.shape[1];
      if (!rings.has(shell)) rings.set(shell, new Float32Array(about.frames * places));
      rings.get(shell).set(array.values, start * places);
    }
  }
  return { ...about, run: answer.run, cut, pressure, rings, scale, limit: ends };
}

function finished(job, signal, tell) {
  return new Promise((done, fail) => {
    const stop = () => {
      unwatch(job.id);
      request(`/api/jobs/${job.id}`, { method: "DELETE" }).catch(() => {});
      fail(new DOMException("stopped", "AbortError"));
    };
    if (signal.aborted) return stop();
    signal.addEventListener("abort", stop, { once: true });
    watch(job, (told) => {
      tell(told.fraction ?? 0);
      if (!ended(told)) return;
      signal.removeEventListener("abort", stop);
      if (told.state === "done") done();
      else fail(told.state === "cancelled" ? new DOMException("stopped", "AbortError") : Object.assign(new Error(told.state), { problem: told.error }));
    });
  });
}

// The number of the last frame at or before a time.
export function frameAt(one, time) {
  const step = one.time.length > 1 ? one.time[1] - one.time[0] : 1;
  return Math.min(one.time.length - 1, Math.max(0, Math.floor((time - one.time[0]) / step + 1e-6)));
}

// Pressure (Pa) at a place (in units of a) of one frame, no farther than the ends of the colours; null outside the picture.
export function pressureAt(one, frame, x, y) {
  const pixel = (2 * one.half_width) / one.size;
  const column = Math.floor((x + one.half_width) / pixel), line = Math.floor((y + one.half_width) / pixel);
  if (column < 0 || line < 0 || column >= one.size || line >= one.size) return null;
  return one.scale * (one.pressure[(frame * one.size + line) * one.size + column] - 128);
}
