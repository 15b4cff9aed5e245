import { beforeEach, describe, expect, it } from "vitest";
import type { Changes, Design } from "../src/protocol/messages";
import { begun } from "../src/state/history";
import { undo } from "../src/state/actions";
import { current, update } from "../src/state/store";
import { differences, dropVariant, freeName, gist, keepVariant, moveVariantUp, renameVariant, takeBack } from "../src/state/variants";
import { type Criterion, percent, resampled, rowsOf } from "../src/views/comparison/figures";

const design = (changes: Changes, text = "t"): Design => ({ text, files: {}, changes });

describe("variants", () => {
  beforeEach(() => update({ text: "t", files: {}, name: "truck.yaml", history: begun({ a: "1" }), variants: [], variantsTold: {}, notice: "" }));

  it("keeps three beside the present design and says that there is no room for more", () => {
    for (const name of ["x", "x", ""]) expect(keepVariant(name)).toBe(true);
    expect(keepVariant("y")).toBe(false);
    expect(current().variants.map(({ name }) => name)).toEqual(["x", "x 2", "variant"]);
    expect(current().notice).toMatch(/remove a variant/);
  });

  it("takes what was told along when variants are moved or removed", () => {
    const told = (view: string) => ({ asks: [{ view }], answers: [] });
    for (const name of ["x", "y", "z"]) keepVariant(name);
    update({ variantsTold: { response: [told("x"), undefined, told("z")] } });
    moveVariantUp(2);
    expect(current().variants.map(({ name }) => name)).toEqual(["x", "z", "y"]);
    dropVariant(0);
    expect(current().variantsTold.response).toEqual([told("z"), undefined]);
  });

  it("takes one of the same file back as a step that can be undone", () => {
    keepVariant("x", design({ b: "2" }));
    takeBack(0);
    expect(current().history.present).toEqual({ b: "2" });
    undo();
    expect(current().history.present).toEqual({ a: "1" });
  });

  it("exchanges one of another file with the present design, so that neither is lost", () => {
    keepVariant("other", design({ b: "2" }, "another file"));
    renameVariant(0, "line");
    takeBack(0);
    expect([current().text, current().name, current().history.present]).toEqual(["another file", "line.yaml", { b: "2" }]);
    expect(current().variants).toEqual([{ name: "truck.yaml", design: design({ a: "1" }) }]);
  });

  it.each([
    [{}, "as loaded"],
    [{ a: "1", "absorber.spring_stiffness": "9 kNm/rad" }, "spring stiffness 9 kNm/rad …"],
    [{ "clutch.damping": null }, "damping removed"],
    [{ absorber: { type: "single_mass_flywheel" } }, "absorber single mass flywheel"],
  ])("has a name for %o", (changes, name) => expect(gist(changes)).toBe(name));

  it("finds a name that is free", () => expect(freeName(" a ", ["a", "a 2"])).toBe("a 3"));
});

describe("differences", () => {
  it("lists the values in which designs differ, and no others", () => {
    const found = differences([design({ same: "1", a: "2" }), design({ same: "1" }), design({ a: null, same: "1", z: { k: 1 } })]);
    expect(found).toEqual([
      { path: "a", values: ["2", undefined, null] },
      { path: "z", values: [undefined, undefined, { k: 1 }] },
    ]);
  });

  it("tells nothing value by value of different files", () => expect(differences([design({}), design({}, "u")])).toBeNull());
});

describe("criteria", () => {
  const criterion = (name: string, value: number, better: Criterion["better"] = "less"): Criterion => ({ name, label: name, quantity: "torque", value, better });

  it("marks the best by its sense, and gives differences to the reference", () => {
    const [torque, stop] = rowsOf([[criterion("torque", 200), criterion("stop", -1, "more")], [criterion("torque", 150), criterion("stop", -2, "more")]], 0);
    expect([torque.best, torque.differences]).toEqual([[false, true], [0, -0.25]]);
    expect([stop.best, stop.differences]).toEqual([[true, false], [null, null]]);
  });

  it("knows no best where all are alike, one is alone, or a design has no answer", () => {
    const [same, alone] = rowsOf([[criterion("same", 1)], [criterion("same", 1), criterion("alone", 2)], null], 1);
    expect([same.best, same.values]).toEqual([[false, false, false], [1, 1, null]]);
    expect([alone.best, alone.differences]).toEqual([[false, false, false], [null, 0, null]]);
  });

  it("finds no share of what is negative", () => expect(rowsOf([[criterion("a", 2)], [criterion("a", -3)]], 0)[0].differences).toEqual([0, null]));
  it("finds no share of nothing", () => expect(rowsOf([[criterion("a", 0)], [criterion("a", 3)]], 0)[0].differences).toEqual([null, null]));

  it.each([[0.123, "+12.3 %"], [-0.004, "−0.40 %"], [1.5, "+150 %"], [-1e-9, "±0.00 %"]])("tells %d", (share, text) => expect(percent(share)).toBe(text));

  it("tells values over other speeds, nothing outside, and not-a-number where it is", () => {
    expect([...resampled([0, 1, 2, 3], [0, 10, NaN, 30], [-1, 0.5, 1, 1.5, 3, 4])]).toEqual([NaN, 5, 10, NaN, 30, NaN]);
    expect([...resampled([1], [5], [1])]).toEqual([NaN]);
  });
});
