// The whole system in the fragment of the address: #s= and base64url of raw deflate of JSON. A long record is the server's to keep:
// the fragment has its checksum.
import { request } from "./api.js";

const LONG = 200; // samples

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function encode(content) {
  const bytes = await through(new TextEncoder().encode(JSON.stringify({ v: 1, ...content })), new CompressionStream("deflate-raw"));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return "#s=" + btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

// The fragment as the server's routes take it, or null when an address holds no system.
export function held(hash = location.hash) {
  return hash.startsWith("#s=") ? hash.slice(1) : null;
}

const isLong = ({ system }) => [system.source].flat().some((source) => source?.pulse?.time?.length > LONG);

// Bring the address up to date; the answer tells how many samples of it only this server has.
export async function put(content) {
  if (!isLong(content)) {
    history.replaceState(null, "", await encode(content));
    return 0;
  }
  const { fragment, samples_kept } = await request("/api/link", { body: { v: 1, ...content } });
  history.replaceState(null, "", `#${fragment}`);
  return samples_kept;
}
