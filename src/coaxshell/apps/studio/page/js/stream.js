// One stream of events for all tabs of this browser: they allow six connections to a server, and a stream keeps its own for good.
// The tab that holds a lock is the one that listens, for itself and the others, and passes on what it hears.
import { client } from "./api.js";

const TAB = "coaxshell-tab-", LISTENER = "coaxshell-stream";
const AGAIN = 1000, LOOK = 3000; // ms until a stream that was refused is asked for again, and between looks for tabs that crashed
let receive = () => {};

// Call `receive(kind, data)` with "hello", "job" and "lost", whichever tab listens.
export function listen(receiver) {
  receive = receiver;
  if (!navigator.locks) return new Listener(() => [client], receive).refresh();
  const channel = new BroadcastChannel(LISTENER);
  navigator.locks.request(TAB + client, () => new Promise(() => {})); // held as long as this tab lives
  let listener = null;
  channel.onmessage = ({ data }) => {
    if (data.kind) return receive(data.kind, data.data);
    if (data.leaves) listener?.gone.add(data.leaves);
    return listener?.refresh();
  };
  addEventListener("pagehide", () => channel.postMessage({ leaves: client }));
  channel.postMessage({ joins: client });
  navigator.locks.request(LISTENER, () => {
    const tell = (kind, data) => { channel.postMessage({ kind, data }); receive(kind, data); };
    listener = new Listener(tabs, tell);
    listener.refresh();
    setInterval(() => listener.refresh(), LOOK);
    return new Promise(() => {});
  });
}

async function tabs() {
  const { held } = await navigator.locks.query();
  return held.map(({ name }) => name).filter((name) => name.startsWith(TAB)).map((name) => name.slice(TAB.length));
}

class Listener {
  constructor(whom, tell) { Object.assign(this, { whom, tell, gone: new Set(), stream: null, heard: "" }); }

  // Listen for the tabs that there are now; the old stream ends once the new one is there, so that no tab is ever without.
  async refresh() {
    const clients = [...new Set([client, ...(await this.whom())])].filter((one) => !this.gone.has(one)).sort();
    const query = clients.map((one) => `client=${one}`).join("&");
    if (query !== this.heard) this.open(query);
  }

  open(query) {
    const stream = new EventSource(`/api/events?${query}`);
    const before = this.stream;
    Object.assign(this, { stream, heard: query });
    stream.addEventListener("hello", ({ data }) => { before?.close(); if (this.stream === stream) this.tell("hello", JSON.parse(data)); });
    stream.addEventListener("job", ({ data }) => { if (this.stream === stream) this.tell("job", JSON.parse(data)); });
    stream.onerror = () => {
      before?.close();
      if (this.stream !== stream) return stream.close();
      this.tell("lost");
      // After an answer that is no stream (a server that is closing) browsers give up for good.
      if (stream.readyState === EventSource.CLOSED) setTimeout(() => { if (this.stream === stream) this.open(query); }, AGAIN);
      return null;
    };
  }
}
