import { describe, expect, it } from "vitest";
import type { Grid } from "../src/protocol/messages";
import { typed, withValues } from "../src/state/takeover";
import { type Criterion, type Front, axesOf, bettered, designAt, dimensionsOf, isWithin, labelled, staircase, stepAlong } from "../src/views/pareto/designs";
import { cell, csvOf } from "../src/views/pareto/saving";

const grid = (...values: number[]): Grid => ({ data: Float64Array.from(values), shape: [values.length] });
const criterion = (name: string, values: number[], more: Partial<Criterion> = {}): Criterion => ({ name, label: name, quantity: "torque", better: "less", objective: true, limits: null, values: grid(...values), ...more });

//            design     0  1  2  3    4  5
const X = [4, 1, 2, NaN, 2, 0];
const Y = [1, 5, 3, 0, 4, 0];
const FRONT: Front = {
  name: "small",
  designs: 6,
  all: 6,
  parameters: [{ path: "a.k", label: "a, k", values: grid(1, 2, 3, 4, 5, 6) }, { path: "a.type", label: "a, type", values: ["x", "y", "x", "y", "=1+1", 'u,"v"'] }],
  criteria: [criterion("mass", [9, 9, 9, 9, 9, 9], { objective: false, limits: [null, 9.5] }), criterion("x", X), criterion("y", Y)],
  on_front: grid(1, 1, 1, 0, 0, 0),
  within: grid(1, 1, 1, 1, 1, 0),
  role: ["nominal", "best x", "", "", "knee, before gradients", ""],
};
const within = (index: number) => isWithin(FRONT, index);
const dimensions = (front: Front) => dimensionsOf(front, (path) => (path === "a.k" ? "stiffness" : null));

describe("fronts", () => {
  const [x, y] = axesOf(FRONT, dimensions(FRONT), undefined, undefined);

  it("begins with the objectives, offers figures and numeric parameters", () => {
    expect([x.key, y.key]).toEqual(["criterion x", "criterion y"]);
    expect(dimensions(FRONT).map(({ key, quantity, sense, limits }) => [key, quantity, sense, limits])).toEqual([
      ["criterion mass", "torque", 1, [9.5]],
      ["criterion x", "torque", 1, []],
      ["criterion y", "torque", 1, []],
      ["parameter a.k", "stiffness", 0, []],
    ]);
    expect(axesOf(FRONT, dimensions(FRONT), "parameter a.k", "nonsense").map(({ key }) => key)).toEqual(["parameter a.k", "criterion x"]);
  });

  it("finds the designs that none within limits betters, from the best along x on", () => {
    expect(bettered(x, y, within)).toEqual([1, 2, 0]);
    expect(bettered(x, y, () => true)).toEqual([5]);
  });

  it("turns about where more is better", () => {
    const upward = dimensions({ ...FRONT, criteria: [criterion("x", X), criterion("y", Y, { better: "more" })] });
    expect(bettered(upward[0], upward[1], within)).toEqual([1]);
    expect(bettered(upward[0], upward[2], within)).toEqual([]);
  });

  it("agrees with a comparison of all pairs", () => {
    const random = Array.from({ length: 400 }, (_, i) => Math.round(50 * Math.abs(Math.sin(12.9898 * (i + 1)))));
    const [a, b] = [random.slice(0, 200), random.slice(200)];
    const [first, second] = dimensions({ ...FRONT, criteria: [criterion("a", a), criterion("b", b)] });
    const betters = (i: number, j: number) => a[i] <= a[j] && b[i] <= b[j] && (a[i] < a[j] || b[i] < b[j]);
    const expected = new Set([...a.keys()].filter((j) => ![...a.keys()].some((i) => betters(i, j))).map((i) => `${a[i]} ${b[i]}`));
    expect(new Set(bettered(first, second, () => true).map((i) => `${a[i]} ${b[i]}`))).toEqual(expected);
  });

  it("draws the edge as steps", () => {
    expect(staircase([1, 2, 0], Float64Array.from(X), Float64Array.from(Y))).toEqual([[1, 2, 2, 4, 4], [5, 5, 3, 3, 1]]);
  });

  it("finds the design next to a pointer, if there is one in reach", () => {
    const [px, py] = [Float64Array.from([0, 10, NaN]), Float64Array.from([0, 0, 0])];
    expect([designAt(px, py, [7, 1], 5), designAt(px, py, [20, 0], 5)]).toEqual([1, null]);
  });

  it("walks along the front and stays at its ends", () => {
    expect([stepAlong([1, 2, 0], null, 1), stepAlong([1, 2, 0], 1, 1), stepAlong([1, 2, 0], 0, 1), stepAlong([1, 2, 0], 5, -1), stepAlong([], 1, 1)]).toEqual([1, 2, 0, 0, null]);
  });

  it("labels what a study names, but not its steps", () => expect(labelled(FRONT)).toEqual([{ index: 0, text: "nominal" }, { index: 1, text: "best x" }]));

  it("is written as a table that no spreadsheet runs", () => {
    const lines = csvOf(FRONT).split("\r\n");
    expect(lines[0]).toBe("\ufeffdesign,a.k,a.type,mass,x,y,on_front,within,role");
    expect(lines[4]).toBe("4,4,y,9,,0,0,1,");
    expect([cell("=1+1"), cell('u,"v"'), cell(-1)]).toEqual(["'=1+1", '"u,""v"""', "-1"]);
  });
});

describe("taking over", () => {
  const stiffness = { unit: "kNm/rad", factor: 1000, label: "" };

  it("types values in the unit that the page shows", () => expect(typed({ path: "k", value: 13000, unit: stiffness })).toBe("13 kNm/rad"));

  it("is read as the very same number, or told in SI", () => {
    for (let i = 1; i < 2000; i++) {
      const value = 8000 + 1234.567 * Math.abs(Math.sin(i));
      const told = typed({ path: "k", value, unit: stiffness });
      expect(typeof told === "number" ? told : parseFloat(String(told)) * 1000).toBe(value);
    }
  });

  it("takes words and plain numbers as they are", () => {
    expect(typed({ path: "t", value: "x", unit: undefined })).toBe("x");
    expect(typed({ path: "n", value: 0.3, unit: { unit: "-", factor: 1, label: "" } })).toBe(0.3);
  });

  it("puts values in the place of those changed before, and leaves the others", () => {
    const changes = { "a.k": "1", b: "2" };
    expect(withValues(changes, [{ path: "a.k", value: 5, unit: undefined }, { path: "c", value: "x", unit: undefined }])).toEqual({ b: "2", "a.k": 5, c: "x" });
  });
});
