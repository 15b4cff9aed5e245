import { describe, expect, it } from "vitest";
import { AMOUNT, RATIO } from "../src/charts/colourmaps";
import { extent, linear, logTicks, nearest, padded, ticks } from "../src/charts/scales";
import { limits } from "../src/views/limits";

describe("axes", () => {
  it.each([
    [[600, 2000], 7, [600, 800, 1000, 1200, 1400, 1600, 1800, 2000]],
    [[-0.3, 0.3], 3, [-0.2, 0, 0.2]],
    [[5, 5], 4, [5]],
  ] as [[number, number], number, number[]][])("has round values in %j", (range, count, values) => {
    expect(ticks(range, count)).toEqual(values);
  });

  it("has 1, 2 and 5 of each decade where they are logarithmic", () => {
    expect(logTicks([4, 210])).toEqual([5, 10, 20, 50, 100, 200]);
  });

  it("goes from values to places and back", () => {
    const scale = linear([600, 2000], [62, 762]);
    expect(scale.place(1300)).toBe(412);
    expect(scale.value(412)).toBe(1300);
  });

  it("takes its range from numbers alone", () => {
    expect(extent([NaN, 3, -1], [2])).toEqual([-1, 3]);
    expect(extent([NaN])).toEqual([0, 1]);
    expect(padded([5, 5])).toEqual([4.5, 5.5]);
  });

  it("finds the value next to the cursor", () => expect(nearest([1, 2, 4], 3.1)).toBe(2));
});

describe("colours", () => {
  it("runs from the ends of the maps through white where things are as they were", () => {
    expect(AMOUNT(0)).toEqual([0, 34, 78]);
    expect(AMOUNT(7)).toEqual([254, 232, 56]);
    expect(RATIO(0.5).every((part) => part > 240)).toBe(true);
  });

  it("rises in lightness, for eyes that see no colour", () => {
    const light = Array.from({ length: 50 }, (_, i) => AMOUNT(i / 49)).map(([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b);
    expect(light.every((value, i) => i === 0 || value > light[i - 1])).toBe(true);
  });

  it("has limits by what the engine reaches, a two-hundredth at least", () => {
    expect(limits([1, 50, 9000, NaN], [1, 1, 0, 1])[1]).toBe(50);
    expect(limits([1, 1000], [1])[0]).toBeCloseTo(4.995, 10);
    expect(limits([NaN, 0], [1])).toEqual([0.1, 1]);
  });
});
