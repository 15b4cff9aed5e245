/** A frame as the server writes it. */
export function framed(header: unknown, values: number[]): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(header));
  const length = Math.ceil((text.length + 4) / 8) * 8 - 4;
  const frame = new ArrayBuffer(4 + length + 8 * values.length);
  const view = new DataView(frame);
  view.setUint32(0, length, true);
  new Uint8Array(frame, 4).fill(0x20, 0, length);
  new Uint8Array(frame, 4).set(text);
  values.forEach((value, i) => view.setFloat64(4 + length + 8 * i, value, true));
  return frame;
}
