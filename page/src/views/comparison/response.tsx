// The main order of all designs at the node that is to be kept quiet.

import { useMemo } from "react";
import { type Line, Lines } from "../../charts/lines";
import { Picture } from "../../charts/picture";
import { row } from "../../protocol/frame";
import type { Ask, Grid, Units } from "../../protocol/messages";
import { useStore } from "../../state/store";
import { axisLabel, shown, told } from "../../units";
import { scaled } from "../values";
import { resampled } from "./figures";

export interface Compared {
  speed: Grid;
  orders: number[];
  places: { name: string; label: string; kind: "node" | "element"; quantity: string }[];
  value: Grid;
  idle: number;
  range: [number, number];
}

interface ResponseProps {
  response: Compared;
  others: { name: string; response: Compared | undefined }[];
  quiet: string;
  ask: Ask;
}

/** Amplitudes of the first order at a node, of a name or else the last that was answered; nothing where there is none. */
function amplitudes(found: Compared, quiet: string, units: Units): Float64Array | null {
  const index = found.places.findIndex(({ name, kind }) => kind === "node" && name === quiet);
  const place = index >= 0 ? index : found.places.findLastIndex(({ kind }) => kind === "node");
  return place < 0 || !found.orders.length ? null : scaled(row(found.value, place, 0), units, found.places[place].quantity);
}

export function QuietResponse({ response, others, quiet, ask }: ResponseProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const speed = useMemo(() => scaled(response.speed.data, units, "speed"), [response, units]);
  const lines = useMemo(() => {
    const own = amplitudes(response, quiet, units);
    const lines: Line[] = own ? [{ name: "present", values: own, colour: 0, width: 2.2 }] : [];
    others.forEach(({ name, response: other }, i) => {
      const found = other && amplitudes(other, quiet, units);
      if (found) lines.push({ name, values: resampled(scaled(other.speed.data, units, "speed"), found, speed), colour: i + 1, dash: i + 1, width: 1.6 });
    });
    return lines;
  }, [response, speed, units, quiet, ...others.flatMap((other) => [other.name, other.response])]);
  if (!lines.length) return null;
  const place = response.places.find(({ name, kind }) => kind === "node" && name === quiet) ?? response.places.findLast(({ kind }) => kind === "node")!;
  const title = `${place.label}: ${place.quantity.replaceAll("_", " ")} of order ${told(response.orders[0])}`;
  const shownRange = response.range.map((value) => shown(units, "speed", value)) as [number, number];
  const figures = () => ({
    columns: [axisLabel(units, "speed"), ...lines.map((line) => line.name)],
    rows: [...speed].map((value, i) => [told(value), ...lines.map((line) => told(line.values[i]))]),
  });
  return (
    <Picture title={title} ask={{ ...ask, nodes: [place.name], elements: [] }} compared={others.length > 0} figures={figures}>
      <Lines label={`${title} over speed`} x={{ values: speed, label: axisLabel(units, "speed", "speed") }} y={{ label: `${axisLabel(units, place.quantity, place.quantity.replaceAll("_", " "))}, 0-peak` }} lines={lines} marks={{ idle: shown(units, "speed", response.idle), range: shownRange }} height={240} />
    </Picture>
  );
}
