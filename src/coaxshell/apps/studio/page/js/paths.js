// Dotted paths such as shells[0].radius, as the library's errors write them.
export function split(path) {
  return [...path.matchAll(/[^.[\]]+/g)].map(([part]) => (/^\d+$/.test(part) ? Number(part) : part));
}

export function join(path, part) {
  return typeof part === "number" ? `${path}[${part}]` : path ? `${path}.${part}` : part;
}

export function read(data, path) {
  return split(path).reduce((part, key) => part?.[key], data);
}

// A copy with one entry changed; undefined removes it.
export function written(data, path, value) {
  const [key, ...rest] = split(path);
  if (key === undefined) return value;
  const copy = Array.isArray(data) ? [...data] : { ...data };
  const inner = rest.length ? written(copy[key] ?? {}, rest.reduce(join, ""), value) : value;
  if (inner === undefined && !rest.length) {
    if (Array.isArray(copy)) copy.splice(key, 1); else delete copy[key];
  } else copy[key] = inner;
  return copy;
}
