// The conversation with the solver: a preview at once, full resolution by itself afterwards, and never an older answer over a newer one.
// Three dimensions take seconds: there the preview is a job too, with progress, and full resolution waits until it is asked for.
import { client, request } from "./api.js";
import { finished } from "./events.js";

const PATIENCE = 900; // ms without a change before full resolution starts
const PAUSE = 150; // and before errors and warnings are asked for
const OFTEN = 400; // ms between bars while a slider moves: they take as long as a run
const AGAIN = 1000, SELDOM = 30_000; // from a failure to the next attempt: at first, and at most
const QUIET = 350; // ms without a movement of a slider before a preview in three dimensions starts
let revision = 0;
let turn = null; // kept once the server has what was asked for last: previews that take seconds are solved in the order of the wishes
export const sent = { rates: false }; // whether velocities and accelerations are, whose transforms a slider would wait for
export const times = []; // ms from a change to the curves of its own run drawn, the newest last; those of the bare system may come before or after

// The curves of a run are drawn now: only those of a preview after a change are timed.
export function drawn(result) {
  if (result?.since === undefined) return;
  times.push(performance.now() - result.since);
  delete result.since;
}

// Whether the same request may be answered a little later.
const passing = ({ status }) => !status || status === 429 || status >= 500;

// Whether two runs have as many shells, and of the same kinds.
const alike = (one, other) => one.shells?.map(({ rigid }) => rigid).join() === other.shells.map(({ rigid }) => rigid).join();

export class Slot {
  // `name` of the slot; `show(result)` draws, `measured(result)` tells that there are newer bars, `judged(result)` if errors and warnings
  // shall follow, `problem(problems)` of the description, `progress(job or null)`,
  // `fail(error, full)` of anything else; `full` tells that only full resolution failed.
  constructor(name, tell) {
    Object.assign(this, { name, tell, wanted: null, busy: false, shown: 0, full: null, timer: 0, result: null, asked: 0, measured: 0 });
  }

  // Ask for a system; the newest wish wins. One request is on its way at a time: a drag gets every answer that there is time for.
  // `moving` says that the next wish may follow at once: what takes seconds waits for the slider to rest, and for nothing else.
  want(system, { resolution = "preview", full = null, since = performance.now(), moving = false } = {}) {
    this.wanted = { system, resolution, full, since, revision: ++revision };
    this.stopFull();
    if (resolution.dimensions === 3) this.timer = setTimeout(() => this.carryOut(resolution, false), moving ? QUIET : 0);
    else if (!this.busy) this.next();
  }

  async next() {
    const wish = this.wanted;
    if (!wish || wish.revision <= this.shown || wish.resolution.dimensions === 3) return;
    this.busy = true;
    try {
      const { system, resolution } = wish;
      const answer = await request("/api/solve", { body: { client, slot: this.name, revision: wish.revision, system, resolution, histories: sent.rates ? "all" : "without rates", bars: "later" } });
      if (this.wanted.revision === wish.revision || (answer && this.shown < wish.revision)) this.take(wish, answer);
    } catch (error) {
      if (this.wanted.revision === wish.revision) { this.shown = wish.revision; this.tell.fail(error); }
    } finally {
      this.busy = false;
      if (this.wanted.revision > wish.revision) this.next();
    }
  }

  take(wish, answer) {
    if (!answer) return;
    this.shown = wish.revision;
    if (!answer.ok) {
      this.stopFull();
      if (this.result) this.measure(this.result, true); // it stays
      // What is too much for a preview may be asked for in full, whose limits have been looked at before.
      if (wish.full && answer.problem.where === "resolution" && this.wanted.revision === wish.revision) return this.refine();
      return this.tell.problem(answer.problems ?? [answer.problem], wish);
    }
    this.keep(wish, answer, false);
    if (wish.full && this.wanted.revision === wish.revision) this.timer = setTimeout(() => this.refine(), PATIENCE);
  }

  keep(wish, answer, full) {
    const before = this.result ?? {}, { estimates = null, warnings = [] } = before; // of the one before, as long as there are none of this one
    const bars = answer.bars ?? (alike(before, answer) ? before.bars : []);
    const result = { estimates, warnings, judged: false, ...answer, bars, withBars: Boolean(answer.bars), full, revision: wish.revision, system: wish.system };
    if (this.name === "current" && !full) result.since = wish.since;
    this.result = result;
    this.tell.show(result);
    this.measure(result);
    if (this.tell.judged && !result.judged) setTimeout(() => this.judge(result), full ? 0 : PAUSE);
  }

  // Bars of a run whose curves came without: at once where it rests, of a few runs on the way while a slider moves. What the server was too
  // busy for, or not there for, is asked for again as long as the run is the one shown.
  async measure(result, stays = false, pause = AGAIN) {
    const rests = stays || this.wanted.revision === result.revision;
    if (result.withBars || (!rests && performance.now() - this.asked < OFTEN)) return;
    this.asked = performance.now();
    const told = await request(`/api/runs/${result.run}/bars`).catch((error) => {
      if (passing(error)) setTimeout(() => this.result === result && this.measure(result, stays, Math.min(2 * pause, SELDOM)), pause);
    });
    const now = this.result;
    if (!told || now.withBars || this.measured > result.revision || !alike(now, result)) return;
    this.measured = result.revision;
    Object.assign(now, { bars: told.bars, withBars: now === result });
    this.tell.measured?.(now);
  }

  async judge(result) {
    const rests = () => this.result === result && this.wanted.revision === result.revision;
    if (!rests()) return;
    const told = await request(`/api/runs/${result.run}/judgement`).catch((error) => ({ estimates: null, warnings: [], unjudged: error.message }));
    if (this.result !== result || !told) return;
    Object.assign(result, told, { judged: true });
    this.tell.judged(result);
  }

  // Full resolution of what is shown.
  refine() { this.carryOut(this.wanted.full, true); }

  // What is wanted, as a job with progress: its full resolution, or a preview that takes seconds.
  carryOut(resolution, full) {
    const wish = this.wanted;
    this.stopFull();
    const body = { kind: "solve", slot: `${this.name}-full`, revision: ++revision, system: wish.system, resolution };
    const work = finished(body, (job) => this.full === work && this.tell.progress?.({ ...job, full }), turn);
    [this.full, turn] = [work, work.asked];
    if (!full) this.tell.progress?.({ fraction: 0, stage: "", full });
    work.promise.then(async (job) => {
      const answer = await request(`/api/runs/${job.run}`);
      if (this.full !== work || this.wanted.revision !== wish.revision || !answer?.run) return;
      this.shown = wish.revision;
      this.keep(wish, { ok: true, ...answer }, full);
    }).catch((error) => { // what preview could show stays
      if (this.full !== work || error.cancelled) return;
      if (!full && error.problem?.problem) this.tell.problem([error.problem], wish);
      else this.tell.fail(error, full);
    }).finally(() => {
      if (this.full !== work) return;
      this.full = null;
      this.tell.progress?.(null);
    });
  }

  stopFull() {
    clearTimeout(this.timer);
    const work = this.full;
    this.full = null;
    work?.cancel();
    if (work) this.tell.progress?.(null);
  }
}
