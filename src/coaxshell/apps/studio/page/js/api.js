// Requests to the server of this page, and the one kind of failure they have.
import { unpack } from "./arrays.js";

export const client = crypto.randomUUID();

export class Failure extends Error {
  constructor(status, { code = "", where = "", problem = "", remedy = "" }) {
    super([where, [problem, remedy].filter(Boolean).join("; ")].filter(Boolean).join(": "));
    Object.assign(this, { status, code, where, problem, remedy });
  }
}

// Give what the server answers: unpacked arrays, JSON, or null for "a newer request has come".
export async function request(path, { body, method, type = "application/json", signal } = {}) {
  const options = { method: method ?? (body === undefined ? "GET" : "POST"), signal, headers: {} };
  if (body !== undefined) {
    options.headers["Content-Type"] = type;
    options.body = type === "application/json" ? JSON.stringify(body) : body;
  }
  let answer;
  try {
    answer = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Failure(0, { code: "unreachable", problem: "the server does not answer", remedy: "is coaxshell studio still running?" });
  }
  if (answer.status === 204) return null;
  const kind = answer.headers.get("Content-Type") ?? "";
  if (kind.startsWith("application/x-coaxshell-arrays")) return unpack(await answer.arrayBuffer());
  const told = kind.startsWith("application/json") ? await answer.json() : {};
  if (!answer.ok) throw new Failure(answer.status, told.error ?? { problem: `the server answered ${answer.status}` });
  return told;
}
