// What can be taken back and done again: states of the page, the last hundred.
const MOST = 100, COALESCED = 1500; // ms within which steps of one slider are one change
let past = [], future = [], lastPath = "", lastTime = 0, told = () => {};

export const onChange = (watcher) => { told = watcher; };
const tell = () => told({ undo: past.length > 0, redo: future.length > 0 });

// Keep a state that a change of an entry is about to replace.
export function keep(state, path, live) {
  const coalesced = live && path === lastPath && performance.now() - lastTime < COALESCED;
  lastPath = path;
  lastTime = performance.now();
  if (!coalesced) past.push(structuredClone(state));
  if (past.length > MOST) past.shift();
  future = [];
  tell();
}

// The state before the last change, or after the next one; null where there is none. `present` is what it replaces.
export const undo = (present) => moved(past, future, present);
export const redo = (present) => moved(future, past, present);

function moved(from, to, present) {
  const state = from.pop() ?? null;
  if (state) to.push(structuredClone(present));
  lastPath = "";
  tell();
  return state;
}
