// What the server tells by itself: the states of jobs, and that it has started anew.
import { client, request } from "./api.js";
import * as stream from "./stream.js";

const watchers = new Map(), everyone = new Set(), restarted = new Set(), moods = new Set();
export const jobs = new Map();
let server = null;

export const onJob = (watcher) => everyone.add(watcher);
export const onRestart = (watcher) => restarted.add(watcher);
export const onConnection = (watcher) => moods.add(watcher);

export function listen() {
  stream.listen((kind, data) => {
    if (kind === "job") return data.client === client && tell(data);
    for (const mood of moods) mood(kind === "hello");
    return kind === "hello" && greeted(data);
  });
}

function greeted(hello) {
  const anew = server !== null && server !== hello.server;
  server = hello.server;
  if (!anew) return;
  jobs.clear();
  watchers.clear();
  for (const watcher of restarted) watcher();
}

function tell(job) {
  if (ended(jobs.get(job.id))) return;
  jobs.set(job.id, job);
  if (jobs.size > 300) jobs.delete(jobs.keys().next().value);
  watchers.get(job.id)?.(job);
  for (const watcher of everyone) watcher(job);
  if (ended(job)) watchers.delete(job.id);
}

export const ended = (job) => ["done", "failed", "cancelled"].includes(job?.state);

// Call the watcher with every state of a job from now on, at once with the present one.
export function watch(job, watcher) {
  watchers.set(job.id, watcher);
  const known = jobs.get(job.id);
  if (known) watcher(known); else tell(job);
}

export const unwatch = (id) => watchers.delete(id);

// Start a job. The watcher is called with each of its states; the answer is the job, or { problem }, or null when it came too late.
export async function start(body, watcher) {
  const answer = await request("/api/jobs", { body: { client, ...body } });
  if (!answer?.job) return answer;
  watch(answer.job, watcher);
  return answer.job;
}

// A promise of the job's end, with its progress on the way. It is asked for once `turn`, a promise, is kept; `asked` tells that it was.
export function finished(body, progress = () => {}, turn = null) {
  let id = null, cancelled = false;
  const follow = (resolve, reject) => (job) => {
    progress(job);
    if (job.state === "done") resolve(job);
    else if (ended(job)) reject(Object.assign(new Error(job.state), { job, problem: job.error, cancelled: job.state === "cancelled" }));
  };
  let asked;
  const promise = new Promise((resolve, reject) => {
    const begin = () => (cancelled ? null : start(body, follow(resolve, reject)));
    asked = (turn ? turn.then(begin) : Promise.resolve(begin())).then((job) => {
      id = job?.id;
      if (!id) reject(Object.assign(new Error("a newer one has come"), { problem: job?.problem, cancelled: !job }));
      else if (cancelled) stop(id);
    }, reject);
  });
  return { promise, asked, cancel() { cancelled = true; if (id) stop(id); } };
}

export async function stop(id) {
  if (!jobs.has(id)) return; // of a server that has ended
  try { await request(`/api/jobs/${id}`, { method: "DELETE" }); } catch { /* it has ended by itself */ }
}
