// The whole system in the fragment of the address: #s= and base64url of raw deflate of JSON.
async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function encode(content) {
  const bytes = await through(new TextEncoder().encode(JSON.stringify({ v: 1, ...content })), new CompressionStream("deflate-raw"));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return "#s=" + btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

// The fragment as the server's routes take it, or null when the address holds no system.
export function held() {
  return location.hash.startsWith("#s=") ? location.hash.slice(1) : null;
}

export async function put(content) {
  const fragment = await encode(content);
  history.replaceState(null, "", fragment);
  return location.origin + location.pathname + fragment;
}
