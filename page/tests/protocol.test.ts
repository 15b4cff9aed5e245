import { describe, expect, it } from "vitest";
import { decodeFrame, row } from "../src/protocol/frame";
import type { Grid } from "../src/protocol/messages";
import { framed } from "./framed";

describe("frames", () => {
  it("puts arrays into their places, not-a-number included", () => {
    const frame = framed({ a: { $array: [1, [2, 2]] }, b: [{ $array: [0, [1]] }], c: "text µ" }, [7, 1, NaN, 3, 4]);
    const { a, b, c } = decodeFrame(frame) as { a: Grid; b: Grid[]; c: string };
    expect([...a.data]).toEqual([1, NaN, 3, 4]);
    expect([...row(a, 1)]).toEqual([3, 4]);
    expect([...b[0].data]).toEqual([7]);
    expect(c).toBe("text µ");
  });

  it("takes a row of a middle axis", () => {
    const grid = { data: Float64Array.from({ length: 24 }, (_, i) => i), shape: [2, 3, 4] };
    expect([...row(grid, 1, 2)]).toEqual([20, 21, 22, 23]);
    expect(row(grid, 1)).toHaveLength(12);
  });

  it.each([0, 3, 11, 16])("refuses a frame cut to %i bytes", (length) => {
    const frame = framed({ a: { $array: [0, [2]] } }, [1, 2]);
    expect(() => decodeFrame(frame.slice(0, length))).toThrow(RangeError);
  });

  it("refuses an array that goes beyond the values", () => {
    expect(() => decodeFrame(framed({ a: { $array: [1, [2]] } }, [1, 2]))).toThrow(/cut off/);
  });
});
