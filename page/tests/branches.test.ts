import { describe, expect, it } from "vitest";
import type { Grid } from "../src/protocol/messages";
import { type BranchLine, motionOf, readingsAt, shownOf, slowSpans } from "../src/views/branches/figures";

const grid = (...values: number[]): Grid => ({ data: Float64Array.from(values), shape: [values.length] });
const line = (speed: number[], value: number[], stable = 1, period = 1): BranchLine => ({
  branch: 0,
  kind: "main",
  period,
  stable: grid(...speed.map(() => stable)),
  speed: grid(...speed),
  value: { "3": grid(...value) },
});

describe("branches", () => {
  it("meets a branch that folds back at every one of its motions", () => {
    const folded = [line([10, 20], [0, 100]), line([20, 15], [100, 150], 0), line([15, 30], [150, 300])];
    const read = (speed: number) => readingsAt(folded, speed, "3").map(({ value, line: { stable } }) => [value, stable.data[0]]);
    expect(read(18)).toEqual([[80, 1], [120, 0], [180, 1]]);
    expect(read(12)).toEqual([[20, 1]]);
    expect(read(31)).toEqual([]);
  });

  it("reads a point where two stretches meet once, and the last one", () => {
    const curve = [line([10, 20, 30], [1, 2, 3])];
    expect(readingsAt(curve, 20, "3").map(({ value }) => value)).toEqual([2]);
    expect(readingsAt(curve, 30, "3").map(({ value }) => value)).toEqual([3]);
  });

  it("joins the ranges of stable slower motion, and leaves unstable and main ones out", () => {
    const lines = [line([1, 9], [0, 0]), line([5, 3], [0, 0], 1, 2), line([4, 6], [0, 0], 1, 2), line([8, 7], [0, 0], 1, 4), line([10, 11], [0, 0], 0, 2)];
    expect(slowSpans(lines)).toEqual([[3, 6], [7, 8]]);
  });

  it("names motions and what can be looked at", () => {
    expect(motionOf(line([1], [1], 0, 2))).toBe("unstable, repeats after 2 ignitions");
    const found = { orders: [3, 1.5] } as Parameters<typeof shownOf>[0];
    expect(shownOf(found).map(([name]) => name)).toEqual(["3", "1.5", "swing"]);
  });
});
