// Reading the description's JSON schema: references, kinds of a union, defaults.
import { title } from "./words.js";

let root = {};

export function use(schema) { root = schema; }

export function resolve(schema) {
  if (!schema?.$ref) return schema ?? {};
  const { $ref, ...beside } = schema;
  const found = $ref.split("/").slice(1).reduce((part, key) => part[key], root);
  return { ...resolve(found), ...beside };
}

// The kinds that a union allows, unions inside unions written out.
export function kinds(schema) {
  const found = resolve(schema);
  return found.anyOf ?? found.oneOf ? (found.anyOf ?? found.oneOf).flatMap((part) => kinds({ ...resolve(part) })) : [found];
}

export function matches(schema, value) {
  if (schema.type === "null") return value === null || value === undefined;
  if (schema.const !== undefined) return value === schema.const;
  if (schema.enum) return schema.enum.includes(value);
  if (schema.type === "array") return Array.isArray(value);
  if (schema.type === "string") return typeof value === "string";
  if (schema.type === "number" || schema.type === "integer") return typeof value === "number" || typeof value === "string";
  if (schema.type === "boolean") return typeof value === "boolean";
  if (schema.title === "Vacuum" && value === "vacuum") return true;
  if (value === null || typeof value !== "object" || Array.isArray(value)) return false;
  if ((schema.required ?? []).some((name) => !(name in value))) return false;
  return Object.entries(schema.properties ?? {}).every(([name, part]) => resolve(part).const === undefined || !(name in value) || value[name] === resolve(part).const)
    && Object.keys(value).every((name) => name in (schema.properties ?? {}));
}

export function kindTitle(schema) {
  const kind = resolve(schema.properties?.type)?.const;
  return title((kind ?? schema.title ?? schema.type ?? "").replace(/-/g, " ").replace(/([a-z])([A-Z])|([A-Z]{2})(?=[A-Z][a-z])/g, "$1$3 $2").replace(/\b[A-Z](?=[a-z])/g, (c) => c.toLowerCase()));
}

// A first value of a kind; `hints` gives those that the schema leaves open.
export function fresh(schema, hints = {}) {
  const found = resolve(schema);
  if ("default" in found) return structuredClone(found.default);
  if (found.const !== undefined) return found.const;
  if (found.anyOf ?? found.oneOf) return fresh(kinds(found)[0], hints);
  if (found.enum) return found.enum[0];
  if (found.type === "array") return Array.from({ length: found.minItems ?? 0 }, () => fresh(found.items, hints));
  if (found.type === "object") {
    const made = {};
    for (const [name, part] of Object.entries(found.properties ?? {})) {
      if (name in hints && kinds(part).some((kind) => matches(kind, hints[name]))) made[name] = structuredClone(hints[name]);
      else if ((found.required ?? []).includes(name) || resolve(part).const !== undefined) made[name] = fresh(part, hints);
    }
    return made;
  }
  if (found.type === "boolean") return false;
  if (found.type === "string") return "";
  if (found.type === "null") return null;
  return found.examples?.[0] ?? found.minimum ?? 1;
}

// Why a number is not within the schema's limits, or null. The library decides; this only spares a wait.
export function limits(schema) {
  const texts = [];
  if (schema.exclusiveMinimum !== undefined) texts.push(`greater than ${schema.exclusiveMinimum}`);
  if (schema.minimum !== undefined) texts.push(`at least ${schema.minimum}`);
  if (schema.exclusiveMaximum !== undefined) texts.push(`less than ${schema.exclusiveMaximum}`);
  if (schema.maximum !== undefined) texts.push(`at most ${schema.maximum}`);
  if (schema.nonzero) texts.push("different from 0");
  return texts.join(", ");
}
