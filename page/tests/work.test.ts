import { describe, expect, it } from "vitest";
import { soundWork } from "../src/state/work";

const design = { text: "t", files: { "a.csv": "1" }, changes: { "a.b": null } };

describe("work out of a link", () => {
  it("is taken as it was given", () => {
    const point = { gear: "4", torque: 100, speed: null };
    const variants = [{ name: "v", design }];
    const work = { name: "n", design, point, view: "map", settings: { map: { order: 3 } }, selected: "clutch", variants };
    expect(soundWork(JSON.parse(JSON.stringify(work)))).toEqual(work);
  });

  it.each([null, 3, [], {}, { design: null }, { design: { text: 1, files: {}, changes: {} } }, { design: { text: "", files: { a: 1 }, changes: {} } }])(
    "needs a design, which %j has not",
    (value) => expect(() => soundWork(value)).toThrow(TypeError),
  );

  it("loses what is not as it should be, and nothing else", () => {
    const odd = { design, name: {}, point: { gear: 3, torque: "x", speed: 60 }, settings: { map: null, modes: { mode: 2 } }, variants: [3, { name: "v" }] };
    const found = soundWork(odd);
    expect(found.point).toEqual({ gear: null, torque: null, speed: 60 });
    expect([found.name, found.settings, found.variants]).toEqual(["", { modes: { mode: 2 } }, []]);
  });
});
