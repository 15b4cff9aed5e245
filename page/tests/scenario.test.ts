import { describe, expect, it } from "vitest";
import type { Grid } from "../src/protocol/messages";
import { type Channel, type Run, chosenRows, panelsOf, parts, valueAt, valuesOf } from "../src/views/scenario/figures";

const grid = (...values: number[]): Grid => ({ data: Float64Array.from(values), shape: [values.length] });
const channel = (name: string, quantity: string | null, ...values: number[]): Channel => ({ name, label: name, quantity, values: grid(...values) });

describe("runs in time", () => {
  it("shows signals of one kind in one panel, a clutch that turns through in another", () => {
    const channels = [channel("twist:dmf", "relative_angle", 0.1, -0.2), channel("twist:clutch", "relative_angle", 0, 70), channel("torque:a:b", "torque", 1), channel("done:x", null, 0), channel("twist:other", "relative_angle", 0)];
    const panels = panelsOf({ channels } as Run);
    expect(panels.map(({ title, channels: inside }) => [title, inside.map(({ name }) => name)])).toEqual([
      ["Twists", ["twist:dmf", "twist:other"]],
      ["Slip", ["twist:clutch"]],
      ["Torques", ["torque:a:b"]],
      ["What is done", ["done:x"]],
    ]);
    expect(parts(channels[2])).toEqual(["torque", "a:b"]);
  });

  it("tells values between instants, and those at the ends beyond them", () => {
    const [time, values] = [Float64Array.from([0, 1, 3]), Float64Array.from([0, 10, 30])];
    expect([-1, 0, 0.5, 1, 2, 3, 9].map((at) => valueAt(time, values, at))).toEqual([0, 0, 5, 10, 20, 30, 30]);
    expect(valueAt(new Float64Array(), new Float64Array(), 1)).toBeNaN();
  });

  it("chooses rows of a long table evenly, both ends among them", () => {
    expect(chosenRows(3, 5)).toEqual([0, 1, 2]);
    expect(chosenRows(101, 5)).toEqual([0, 25, 50, 75, 100]);
  });

  it("reads lines as a scenario's file has them", () => {
    expect(valuesOf("# tip-in\nduration: 3 s\n\ngear: 5\nwith_brake: true\nthrottle: [0, 1 s, 2]\nlaw: a: b")).toEqual({ duration: "3 s", gear: 5, with_brake: true, throttle: [0, "1 s", 2], law: "a: b" });
    expect(valuesOf("")).toEqual({});
  });

  it.each(["duration 3", "duration:", ": 3"])("says of %o that it is no line", (line) => expect(() => valuesOf(line)).toThrow(/key: value/));
});
