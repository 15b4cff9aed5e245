import { describe, expect, it } from "vitest";
import { begun, changed, redone, replaced, runEnded, undone } from "../src/state/history";
import { fragment, packed, unpacked } from "../src/state/link";
import { amount, countedText, scaledText, shown, steppedText, told } from "../src/units";

describe("history", () => {
  it("counts a run of edits in one field as one step", () => {
    let history = begun();
    for (const text of ["1", "12", "12 k", "12 kNm/rad"]) history = changed(history, "absorber.stiffness", text);
    history = changed(history, "clutch.damping", "30");
    expect(undone(history).present).toEqual({ "absorber.stiffness": "12 kNm/rad" });
    expect(undone(undone(history)).present).toEqual({});
  });

  it("begins a new step after a run has ended", () => {
    const first = runEnded(changed(begun(), "a", "1"));
    expect(undone(changed(first, "a", "2")).present).toEqual({ a: "1" });
  });

  it("redoes what was undone until something else is changed", () => {
    const history = undone(replaced(begun(), { a: "1" }));
    expect(redone(history).present).toEqual({ a: "1" });
    expect(redone(changed(history, "b", "2")).present).toEqual({ b: "2" });
  });

  it("drops values below a block that is set as a whole, and only those", () => {
    const history = begun({ "absorber.stiffness": "1", absorbers: "2" });
    expect(changed(history, "absorber", { type: "x" }).present).toEqual({ absorbers: "2", absorber: { type: "x" } });
  });

  it("leaves no step behind where nothing changed, and gives back what the file says", () => {
    const history = changed(begun(), "a", "1");
    expect(changed(history, "a", "1")).toBe(history);
    expect(changed(history, "a", undefined).present).toEqual({});
  });
});

describe("links", () => {
  it("carries a design there and back", async () => {
    const design = { text: "näme: µ\n".repeat(9000), files: { "a.csv": "1;2" }, changes: { "a.b": null } };
    const link = await packed(design);
    expect(link).toMatch(/^[\w-]+$/);
    expect(await unpacked(link)).toEqual(design);
  });

  it("refuses one that was cut", async () => {
    const link = await packed({ text: "abcdefghijklmnopqrstuvwxyz0123456789" });
    await expect(unpacked(link.slice(0, -8))).rejects.toThrow();
  });

  it("finds its place in the address", () => {
    expect(fragment("#token=a-b&d=c_d")).toEqual({ token: "a-b", d: "c_d" });
    expect(fragment("")).toEqual({});
  });
});

describe("units", () => {
  const units = { speed: { unit: "rpm", factor: Math.PI / 30, label: "mean engine speed" } };

  it("shows speeds in rpm", () => {
    expect(shown(units, "speed", 62.83185307179586)).toBeCloseTo(600, 10);
    expect(amount(units, "speed", 62.83185307179586)).toBe("600 rpm");
  });

  it.each([
    ["25 kNm/rad", 1.01, "25.25 kNm/rad"],
    ["2.8e5", 1.01, "282800"],
    ["-0.5", 2, "-1"],
    [".3kgm²", 0.9, "0.27kgm²"],
  ])("steps %s by %d", (text, factor, stepped) => expect(scaledText(text, factor)).toBe(stepped));

  it.each([
    ["0.30 kgm²", 1.01, "0.303 kgm²"],
    ["0 Nm", 1.01, "0.01 Nm"],
    ["0.0", 1 / 1.01, null],
    ["full_load", 1.01, null],
  ])("steps %s by %d from zero too", (text, factor, stepped) => expect(steppedText(text, factor)).toBe(stepped));

  it.each([["4", 1.01, "5"], ["4", 1 / 1.01, "3"], ["20", 1.1, "30"], ["4.5", 1.01, null]])("counts %s by %d", (text, factor, counted) =>
    expect(countedText(text, factor)).toBe(counted),
  );

  it("steps no text without a number", () => expect(scaledText("full_load", 1.01)).toBeNull());

  it.each([[NaN, "–"], [0, "0"], [123456.7, "123500"], [1.5e-6, "1.5e-6"]])("tells %d", (value, text) =>
    expect(told(value)).toBe(text),
  );
});
