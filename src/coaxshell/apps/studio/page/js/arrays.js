// The format application/x-coaxshell-arrays: a JSON header, then numbers in bulk.
const TYPES = { float32: Float32Array, uint8: Uint8Array };

export function unpack(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays = {};
  for (const { name, dtype, shape, offset, unit, scale } of header.arrays) {
    const size = shape.reduce((a, b) => a * b, 1);
    arrays[name] = { values: new TYPES[dtype](buffer, 4 + length + offset, size), shape, unit, scale };
  }
  return { ...header, arrays };
}

// Row i of an array, along its last dimension, without a copy.
export function row({ values, shape }, i) {
  const length = shape.at(-1);
  return values.subarray(i * length, (i + 1) * length);
}
