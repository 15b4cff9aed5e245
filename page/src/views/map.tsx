// One order at one place over speed and mean torque, in all gears side by side or in one.

import { useMemo } from "react";
import { ColourBar } from "../charts/colourbar";
import { AMOUNT, RATIO } from "../charts/colourmaps";
import { type Colours, Heat } from "../charts/heat";
import type { Paper } from "../charts/plane";
import { type Figures, Picture } from "../charts/picture";
import { row } from "../protocol/frame";
import type { Ask, Grid, Units } from "../protocol/messages";
import { setPoint } from "../state/actions";
import { type Told, useStore } from "../state/store";
import { amount, axisLabel, shown, si, told as number } from "../units";
import { limits } from "./limits";
import { Choose } from "./settings";
import { scaled, words } from "./values";
import type { Context, Shown, View } from "./view";

interface MapAnswer {
  gears: string[];
  place: string;
  label: string;
  kind: "node" | "element";
  quantity: string;
  order: number;
  speed: Grid;
  torque: Grid;
  value: Grid;
  within: Grid;
  full_load: Grid;
}

function asks({ model, point, settings }: Context): Ask[] {
  const ask: Ask = { view: "map" };
  const place = settings.place;
  if (typeof place === "string" && (!model || model.nodes.includes(place) || model.elements.includes(place))) ask.place = place;
  if (typeof settings.order === "number") ask.order = settings.order;
  if (settings.quantity) ask.quantity = settings.quantity;
  const gear = point.gear ?? model?.gear;
  if (settings.one === true && gear) ask.gears = [gear];
  return [ask];
}

/** What is drawn: amplitudes in the shown unit, or their ratio to a variant's. */
function contents(found: MapAnswer, base: MapAnswer | undefined, units: Units): { values: Float64Array; colours: Colours } {
  const values = scaled(found.value.data, units, found.quantity);
  if (!base || base.value.data.length !== found.value.data.length) {
    return { values, colours: { map: AMOUNT, range: limits(values, found.within.data) } };
  }
  const ratio = found.value.data.map((value, i) => value / base.value.data[i]);
  const [low, high] = limits(ratio, found.within.data);
  const most = Math.min(Math.max(high, 1 / low, 1.1), 10);
  return { values: ratio, colours: { map: RATIO, range: [1 / most, most] } };
}

function MapView({ told, variants, model, settings, set }: Shown) {
  const found = told.answers[0] as MapAnswer;
  const units = useStore((state) => state.start?.units ?? {});
  const chosen = variants.find(({ name }) => name === settings.base);
  const base = chosen?.told?.answers[0] as MapAnswer | undefined;
  const { values, colours } = useMemo(() => contents(found, base, units), [found, base, units]);
  const isRatio = colours.map === RATIO;
  const what = `${words(found.quantity)} of ${words(found.label)}, order ${found.order}`;
  const label = isRatio ? `times that of ${chosen?.name}` : `${axisLabel(units, found.quantity, words(found.quantity))}, 0-peak`;
  return (
    <>
      <MapSettings found={found} variants={variants.map(({ name }) => name)} model={model} settings={settings} set={set} />
      <Picture title={what[0].toUpperCase() + what.slice(1)} ask={told.asks[0]} compared={isRatio} figures={() => figures(found, values, units)}>
        <ColourBar colours={colours} label={label} />
        <div className={found.gears.length > 1 ? "maps" : "maps one"}>
          {found.gears.map((gear, index) => (
            <GearMap key={gear} found={found} index={index} values={values} colours={colours} unit={isRatio ? "times" : ""} />
          ))}
        </div>
      </Picture>
    </>
  );
}

interface GearMapProps {
  found: MapAnswer;
  index: number;
  values: Float64Array;
  colours: Colours;
  unit: string;
}

function GearMap({ found, index, values, colours, unit }: GearMapProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const size = found.torque.data.length * found.speed.data.length;
  const own = useMemo(() => values.subarray(index * size, (index + 1) * size), [values, index, size]);
  const speed = useMemo(() => scaled(found.speed.data, units, "speed"), [found, units]);
  const torque = useMemo(() => scaled(found.torque.data, units, "torque"), [found, units]);
  const read = (r: number, c: number) => {
    const value = own[r * speed.length + c];
    const size = unit ? `${number(value, 3)} ${unit}` : `${number(value)} ${axisUnit(units, found.quantity)}`;
    return `${number(speed[c])} rpm, ${number(torque[r])} Nm: ${Number.isNaN(value) ? "not solved" : size}${found.within.data[r * speed.length + c] ? "" : " (beyond full load)"}`;
  };
  const pick = (r: number, c: number) =>
    setPoint({ gear: found.gears[index], speed: si(units, "speed", Math.round(speed[c])), torque: si(units, "torque", Math.round(torque[r])) });
  const alone = found.gears.length === 1;
  return (
    <section aria-label={`Gear ${found.gears[index]}`}>
      <h4>Gear {found.gears[index]}</h4>
      <Heat
        label={`Map of gear ${found.gears[index]}`}
        x={{ values: speed, range: [speed[0], speed.at(-1)!], label: alone ? axisLabel(units, "speed", "speed") : "speed [rpm]" }}
        y={{ values: torque, range: [torque[0], torque.at(-1)!], label: alone ? axisLabel(units, "torque", "mean torque") : "torque [Nm]" }}
        values={own}
        colours={colours}
        height={alone ? 430 : 190}
        over={(paper) => <FullLoad paper={paper} speed={speed} torque={found.full_load.data} />}
        read={read}
        onPick={pick}
      />
    </section>
  );
}

function axisUnit(units: Units, quantity: string): string {
  return amount(units, quantity, 0).replace(/^0 ?/, "");
}

/** The full-load curve, and a veil over what the engine does not reach. */
function FullLoad({ paper, speed, torque }: { paper: Paper; speed: Float64Array; torque: Float64Array }) {
  if (!torque.some((value) => Number.isFinite(value))) return null;
  const { top, left, width, height, look } = paper;
  const within = (place: number) => Math.min(Math.max(place, top), top + height);
  const points = [...speed].map((value, i) => `${paper.x.place(value).toFixed(1)} ${within(Number.isFinite(torque[i]) ? paper.y.place(torque[i]) : top + height).toFixed(1)}`);
  return (
    <>
      <path d={`M${left} ${top}L${points.join("L")}L${left + width} ${top}Z`} fill={look.paper} fillOpacity={0.82} pointerEvents="none" />
      <path d={`M${points.join("L")}`} fill="none" stroke={look.ink} strokeWidth={1.6} pointerEvents="none" />
    </>
  );
}

type MapSettingsProps = Pick<Shown, "model" | "settings" | "set"> & { found: MapAnswer; variants: string[] };

function MapSettings({ found, variants, model, settings, set }: MapSettingsProps) {
  const places = [...model.nodes, ...model.elements].map((name): [string, string] => [name, words(name)]);
  const orders = [...new Set([...model.orders, found.order])].map((order): [string, string] => [String(order), String(order)]);
  return (
    <div className="settings" role="group" aria-label="Settings of the map">
      <Choose label="Place" options={places} value={found.place} put={(place) => set({ place })} />
      <Choose label="Order" options={orders} value={String(found.order)} put={(order) => set({ order: Number(order) })} />
      {found.kind === "node" && <Choose label="by" options={[["acceleration", "acceleration"], ["angular_velocity", "angular velocity"], ["angle", "angle"]]} value={found.quantity} put={(quantity) => set({ quantity })} />}
      <Choose label="Gears" options={[["all", "all"], ["one", "the one engaged"]]} value={settings.one === true ? "one" : "all"} put={(one) => set({ one: one === "one" })} />
      {variants.length > 0 && <Choose label="Ratio to" options={[["", "none"], ...variants.map((name): [string, string] => [name, name])]} value={String(settings.base ?? "")} put={(base) => set({ base })} />}
    </div>
  );
}

function figures(found: MapAnswer, values: Float64Array, units: Units): Figures {
  const speed = scaled(found.speed.data, units, "speed");
  const grid = { data: values, shape: found.value.shape };
  const rows = found.gears.flatMap((gear, g) => [...found.torque.data].map((torque, t) => [gear, number(shown(units, "torque", torque)), ...[...row(grid, g, t)].map((value) => number(value, 3))]));
  return { columns: ["gear", "torque [Nm]", ...[...speed].map((value) => `${number(value)} rpm`)], rows };
}

/** Of each gear the largest amplitude within full load. */
function summary(told: Told, units: Units): string {
  const found = told.answers[0] as MapAnswer;
  const most = found.gears.map((gear, g) => `gear ${gear} ${amount(units, found.quantity, limits(row(found.value, g), found.within.data)[1], 3)}`);
  return `Order ${found.order} of ${words(found.place)}, at most: ${most.join(", ")}`;
}

export const MAP: View = { name: "map", title: "Map", asks, compares: true, component: MapView, summary };
