// Natural frequencies of all gears over speed, crossed by the lines of the orders.

import { useMemo } from "react";
import { type Line, Lines } from "../charts/lines";
import { type Figures, Picture } from "../charts/picture";
import { row } from "../protocol/frame";
import type { Ask, Grid, Units } from "../protocol/messages";
import { setPoint } from "../state/actions";
import { useStore } from "../state/store";
import { axisLabel, shown, si, told as number } from "../units";
import { Choices } from "./settings";
import { scaled, words } from "./values";
import type { Context, Shown, View } from "./view";

interface Interference {
  gears: string[];
  torque: number;
  orders: number[];
  speed: Grid;
  frequency: Grid;
  crossing: Grid;
  name: string[][];
  idle: number;
  range: [number, number];
}

function asks({ point, settings }: Context): Ask[] {
  const ask: Ask = { view: "interference" };
  if (point.torque !== null) ask.torque = point.torque;
  if (Array.isArray(settings.orders) && settings.orders.length) ask.orders = settings.orders;
  return [ask];
}

/** The largest frequency that is drawn: a little beyond the highest order at the highest speed. */
function highest(found: Interference): number {
  return (1.05 * Math.max(...found.orders, 1) * Math.max(found.range[1], found.speed.data.at(-1)!)) / (2 * Math.PI);
}

function orderLines(found: Interference): Line[] {
  return found.orders.map((order, i) => ({
    name: `order ${order}`,
    values: found.speed.data.map((speed) => (order * speed) / (2 * Math.PI)),
    colour: 7,
    dash: 1 + (i % 3),
    width: 1.5,
  }));
}

/** Frequencies of one gear that are low enough to be seen and are elastic, as lines. */
function gearLines(found: Interference, index: number, faint: boolean): Line[] {
  const top = highest(found);
  const modes = Array.from({ length: found.frequency.shape[1] }, (_, mode) => row(found.frequency, index, mode));
  const seen = modes.map((values, mode) => ({ values, mode })).filter(({ values }) => values.some((value) => value > 0.1 && value < top));
  return seen.map(({ values, mode }, i) => ({
    name: `${mode + 1} ${words(found.name[index]?.[mode] ?? "")}${faint ? ` · gear ${found.gears[index]}` : ""}`.trim(),
    values,
    colour: i % 7,
    dash: i < 7 ? 0 : 1,
    width: faint ? 1 : 2.2,
    faint,
  }));
}

function InterferenceView({ told, model, settings, set }: Shown) {
  const found = told.answers[0] as Interference;
  const units = useStore((state) => state.start?.units ?? {});
  const at = useStore((state) => state.point.speed);
  const chosen = Math.max(found.gears.indexOf(model.gear), 0);
  const speed = useMemo(() => scaled(found.speed.data, units, "speed"), [found, units]);
  const lines = useMemo(() => {
    const others = found.gears.flatMap((_, i) => (i === chosen ? [] : gearLines(found, i, true)));
    return [...others, ...gearLines(found, chosen, false), ...orderLines(found)];
  }, [found, chosen]);
  const in_rpm = (value: number) => shown(units, "speed", value);
  const marks = { idle: in_rpm(found.idle), range: found.range.map(in_rpm) as [number, number], at: at === null ? null : in_rpm(at) };
  return (
    <>
      <div className="settings" role="group" aria-label="Settings of the interference diagram">
        <Choices label="Orders" options={model.orders.map(String)} chosen={found.orders.map(String)} put={(orders) => set({ orders: orders.map(Number) })} />
        <small>Gear {found.gears[chosen]} in strong lines, the others faint.</small>
        {settings.orders !== undefined && <button type="button" onClick={() => set({ orders: null })}>Usual orders</button>}
      </div>
      <Picture title="Natural frequencies and orders" ask={told.asks[0]} figures={() => crossings(found, units)}>
        <Lines label="Natural frequencies over speed, crossed by orders" x={{ values: speed, label: axisLabel(units, "speed", "speed") }} y={{ label: axisLabel(units, "frequency"), range: [0, highest(found)] }} lines={lines} marks={marks} onPick={(value) => setPoint({ speed: si(units, "speed", Math.round(value)) })} height={460} />
      </Picture>
    </>
  );
}

/** The speeds at which orders meet modes, within the range. */
function crossings(found: Interference, units: Units): Figures {
  const rows = found.gears.flatMap((gear, g) =>
    Array.from({ length: found.crossing.shape[1] }, (_, mode) => ({ gear, mode, speeds: row(found.crossing, g, mode), name: found.name[g]?.[mode] ?? "" }))
      .filter(({ speeds }) => speeds.some((speed) => Number.isFinite(speed)))
      .map(({ mode, speeds, name }) => [gear, `${mode + 1} ${words(name)}`, ...[...speeds].map((speed) => number(shown(units, "speed", speed)))]),
  );
  return { columns: ["gear", "mode", ...found.orders.map((order) => `order ${order} at [rpm]`)], rows };
}

export const INTERFERENCE: View = { name: "interference", title: "Interference", asks, compares: false, component: InterferenceView };
