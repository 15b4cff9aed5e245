import { describe, expect, it } from "vitest";
import type { ChainLink, Grid } from "../src/protocol/messages";
import { type Moved, windupOf } from "../src/views/scenario/windup";

const grid = (shape: number[], ...values: number[]): Grid => ({ data: Float64Array.from(values), shape });
const link = (name: string, ...nodes: string[]): ChainLink => ({ name, label: name, kind: "spring", nodes, told: "", path: "" });
const angles = ({ angle }: { angle: Float64Array[] }) => angle.map((values) => [...values]);

describe("winding up", () => {
  // The crank is the second node; behind the gear (ratio 0.5) angles are half of those before it.
  const moved: Moved = { crank: "b", nodes: ["a", "b", "c", "d"], speed_ratio: grid([4], 1, 1, 1, 0.5), angle: grid([4, 2], 1, 2, 1, 1, 1.5, 3, 0.75, 1.4) };
  const links = [link("ab", "a", "b"), link("bc", "b", "c"), link("gear", "c", "d")];

  it("adds twists up from the crank both ways, gears taken out", () => {
    const found = windupOf(moved, links);
    const [a, b, c, d] = angles(found);
    expect([a, b, c]).toEqual([[0, 1], [0, 0], [0.5, 2]]);
    expect(d[0]).toBeCloseTo(0.5, 12);
    expect(d[1]).toBeCloseTo(2 + 0.5 * (1.4 / 0.5 - 3), 12);
    expect([found.links.length, found.cut]).toEqual([3, []]);
  });

  it("begins anew behind a connection that turns through", () => {
    const slipping = { ...moved, angle: grid([4, 2], 0, 0, 0, 0, 0, -30, 0.1, -15.1) };
    const found = windupOf(slipping, links);
    expect(found.cut).toEqual(["bc"]);
    expect(angles(found)[2]).toEqual([0, 0]);
    expect(angles(found)[3][1]).toBeCloseTo(-0.1, 12);
  });

  it("leaves nodes out that the drawing does not link", () => {
    const found = windupOf(moved, [link("xy", "x", "y"), link("cd", "c", "d")]);
    expect([found.nodes, found.links, angles(found)[0]]).toEqual([["c", "d"], [[0, 1]], [0, 0]]);
  });
});
