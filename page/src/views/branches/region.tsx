// Where the line shakes at half the engine's order, over speed and mean torque.

import { useMemo, useState } from "react";
import { AMOUNT } from "../../charts/colourmaps";
import { ColourBar } from "../../charts/colourbar";
import { type Colours, Heat } from "../../charts/heat";
import { type Paper, pathOf } from "../../charts/plane";
import { Picture } from "../../charts/picture";
import { type Range, extent, padded } from "../../charts/scales";
import { type Format, exportJob } from "../../protocol/client";
import type { Grid, Units } from "../../protocol/messages";
import { current, useStore } from "../../state/store";
import { amount, axisLabel, shown, told } from "../../units";
import { Choose } from "../settings";
import { scaled, words } from "../values";

export interface Region {
  gear: string;
  order: number;
  element: string;
  node: string;
  speed: Grid;
  torque: Grid;
  amplitude: Grid;
  twist_amplitude: Grid;
  acceleration: Grid;
  stable_solutions: Grid;
  boundary: { speed: Grid; torque: Grid; curve: Grid; kind: string[] };
  full_load: { speed: Grid; torque: Grid } | null;
  rows: { torque: number; from: number; to: number }[];
}

const SHOWN = ["amplitude", "acceleration", "twist_amplitude"] as const;
type Seen = (typeof SHOWN)[number];
const QUANTITIES: { [seen in Seen]: string } = { amplitude: "torque", acceleration: "acceleration", twist_amplitude: "relative_angle" };

export function RegionPicture({ found }: { found: Region }) {
  const units = useStore((state) => state.start?.units ?? {});
  const [seen, see] = useState<Seen>("amplitude");
  const place = (name: Seen) => words(name === "acceleration" ? found.node : found.element);
  const available = SHOWN.filter((name) => place(name));
  const title = `Order ${told(found.order)} over speed and torque${found.gear ? `, gear ${found.gear}` : ""}`;
  const isCalm = !found.rows.length;
  const save = (format: Format) => exportJob(current().jobs.region!.result!.id, "region", format);
  return (
    <Picture title={title} save={save} figures={() => figuresOf(found, units)}>
      <Choose label="Shown" options={available.map((name) => [name, `${QUANTITIES[name].replaceAll("_", " ")} of ${place(name)}`])} value={seen} put={(name) => see(name as Seen)} />
      {isCalm ? <p className="note">{`Order ${told(found.order)} arises nowhere in this range.`}</p> : <RegionPlane found={found} seen={seen} units={units} title={title} />}
    </Picture>
  );
}

const FAINTEST = 50;

function RegionPlane({ found, seen, units, title }: { found: Region; seen: Seen; units: Units; title: string }) {
  const quantity = QUANTITIES[seen];
  const speed = useMemo(() => scaled(found.speed.data, units, "speed"), [found, units]);
  const torque = useMemo(() => scaled(found.torque.data, units, "torque"), [found, units]);
  const values = useMemo(() => scaled(found[seen].data, units, quantity), [found, seen, units, quantity]);
  const colours = useMemo<Colours>(() => {
    const most = extent(values)[1];
    return { map: AMOUNT, range: [most / FAINTEST, most] };
  }, [values]);
  const read = (row: number, column: number) => readingText(found, seen, row, column, units);
  const bounds = useMemo(() => boundsOf(found, units), [found, units]);
  return (
    <>
      <Heat label={title} height={400} values={values} colours={colours} read={read} x={{ values: speed, range: rangeOf(speed), label: axisLabel(units, "speed", "speed") }} y={{ values: torque, range: rangeOf(torque), label: axisLabel(units, "torque", "mean engine torque") }} over={(paper) => <Over paper={paper} found={found} bounds={bounds} units={units} />} />
      <ColourBar colours={colours} label={`${axisLabel(units, quantity, quantity.replaceAll("_", " "))}, 0-peak`} />
    </>
  );
}

function rangeOf(values: Float64Array): Range {
  return padded(extent(values), 0.5 / Math.max(values.length - 1, 1));
}

function readingText(found: Region, seen: Seen, row: number, column: number, units: Units): string {
  const at = row * found.speed.data.length + column;
  const value = found[seen].data[at];
  const place = `${amount(units, "speed", found.speed.data[column])}, ${amount(units, "torque", found.torque.data[row])}`;
  const size = value > 0 ? `${amount(units, QUANTITIES[seen], value)} 0-peak` : `no order ${told(found.order)}`;
  const stable = found.stable_solutions.data[at];
  return `${place}: ${size}${stable > 1 ? `; ${stable} stable motions` : ""}`;
}

type Bound = [x: number[], y: number[]];

/** The curves about the region, each from its own points. */
function boundsOf(found: Region, units: Units): Bound[] {
  const { speed, torque, curve } = found.boundary;
  const curves = new Map<number, Bound>();
  curve.data.forEach((number, i) => {
    if (!curves.has(number)) curves.set(number, [[], []]);
    const [x, y] = curves.get(number)!;
    x.push(shown(units, "speed", speed.data[i]));
    y.push(shown(units, "torque", torque.data[i]));
  });
  return [...curves.values()];
}

function Over({ paper, found, bounds, units }: { paper: Paper; found: Region; bounds: Bound[]; units: Units }) {
  const { look, left, top, width, height } = paper;
  const full = found.full_load;
  const clip = { clipPath: "url(#region-clip)" };
  return (
    <>
      <clipPath id="region-clip"><rect x={left} y={top} width={width} height={height} /></clipPath>
      <rect x={left} y={top} width={width} height={height} fill="none" stroke={look.grid} />
      {bounds.map(([x, y], i) => <path key={i} d={pathOf(paper, x, y)} fill="none" stroke={look.colours[1]} strokeWidth={2} {...clip} />)}
      {full && <path d={pathOf(paper, scaled(full.speed.data, units, "speed"), scaled(full.torque.data, units, "torque"))} fill="none" stroke={look.ink} strokeWidth={2} strokeDasharray="8 4" {...clip} />}
    </>
  );
}

function figuresOf(found: Region, units: Units) {
  return {
    columns: [axisLabel(units, "torque", "mean torque"), axisLabel(units, "speed", "from speed"), axisLabel(units, "speed", "to speed")],
    rows: found.rows.map(({ torque, from, to }) => [told(shown(units, "torque", torque)), told(shown(units, "speed", from)), told(shown(units, "speed", to))]),
  };
}
