import { describe, expect, it } from "vitest";
import { keyFactor } from "../src/parts/knob";
import { faultText, isAbout, limitsOf } from "../src/parts/limits";
import type { Fault, Field } from "../src/protocol/messages";

const FIELD: Field = {
  path: "absorber.stiffness", label: "stiffness", section: "", kind: "quantity", quantity: "stiffness", text: "13 kNm/rad", value: 13e3,
  given: true, unit: "Nm/rad", least: null, above: 0, most: 1e9, below: null, choices: [], help: "",
};
const FAULT: Fault = { where: "absorber.stages.0.stiffness", problem: "too soft", found: "-1", allowed: "above 0", remedy: "", text: "t" };
const press = (key: string, more = {}) => keyFactor({ key, shiftKey: false, altKey: false, ctrlKey: false, metaKey: false, ...more });

describe("fields", () => {
  it("tells their limits in words", () => {
    expect(limitsOf(FIELD)).toBe("above 0, at most 1e+9 Nm/rad");
    expect(limitsOf({ ...FIELD, above: null, most: null })).toBe("");
  });

  it("has the faults of its own value and of what is inside it, not of neighbours", () => {
    expect(["absorber", "absorber.stages", "absorber.stages.0.stiffness"].every((path) => isAbout(FAULT, path))).toBe(true);
    expect(isAbout(FAULT, "absorber.stage")).toBe(false);
    expect(isAbout({ ...FAULT, where: "absorber.stages[0].stiffness" }, "absorber.stages.0")).toBe(true);
  });

  it("tells what is wrong, what was found and what is allowed", () => {
    expect(faultText(FAULT)).toBe("too soft: found -1; allowed: above 0");
  });

  it("turns values by keys and back to where they were", () => {
    expect(press("ArrowUp")! * press("ArrowDown")!).toBeCloseTo(1, 12);
    expect(press("ArrowUp", { shiftKey: true })).toBeCloseTo(1.1);
    expect(press("ArrowUp", { altKey: true })).toBeCloseTo(1.001);
    expect(press("ArrowUp", { ctrlKey: true })).toBeNull();
    expect(press("a")).toBeNull();
  });
});
