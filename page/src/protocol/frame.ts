// A frame is a length, a JSON header, and float64 values that the header's {"$array": [offset, shape]} refer to.

import type { Grid } from "./messages";

const LITTLE = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** The header of a frame with every array in its place; throws RangeError for bytes that are no frame. */
export function decodeFrame(bytes: ArrayBuffer): unknown {
  const length = bytes.byteLength < 4 ? Infinity : new DataView(bytes).getUint32(0, true);
  const start = 4 + length;
  if (start > bytes.byteLength || start % 8 || (bytes.byteLength - start) % 8) {
    throw new RangeError("the answer is not a whole frame");
  }
  const values = float64(bytes, start);
  return placed(JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))), values);
}

function float64(bytes: ArrayBuffer, start: number): Float64Array {
  if (LITTLE) return new Float64Array(bytes, start);
  const view = new DataView(bytes, start);
  return Float64Array.from({ length: view.byteLength / 8 }, (_, i) => view.getFloat64(8 * i, true));
}

function placed(value: unknown, values: Float64Array): unknown {
  if (Array.isArray(value)) return value.map((item) => placed(item, values));
  if (value === null || typeof value !== "object") return value;
  const entries = Object.entries(value);
  if (entries.length === 1 && entries[0][0] === "$array") return grid(entries[0][1], values);
  return Object.fromEntries(entries.map(([key, item]) => [key, placed(item, values)]));
}

function grid(told: unknown, values: Float64Array): Grid {
  const [offset, shape] = told as [number, number[]];
  const size = shape.reduce((product, length) => product * length, 1);
  if (offset + size > values.length) throw new RangeError("an array of the answer is cut off");
  return { data: values.subarray(offset, offset + size), shape };
}

/** One row of a grid by its leading indices, without a copy. */
export function row(grid: Grid, ...indices: number[]): Float64Array {
  const size = grid.shape.slice(indices.length).reduce((product, length) => product * length, 1);
  const at = indices.reduce((sum, index, axis) => sum * grid.shape[axis] + index, 0);
  return grid.data.subarray(at * size, (at + 1) * size);
}
