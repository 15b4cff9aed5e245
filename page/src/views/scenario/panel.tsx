// Signals of one kind over time, with the player's cursor, events and stops.

import { useMemo } from "react";
import { type Line, Lines } from "../../charts/lines";
import { Picture } from "../../charts/picture";
import { extent, padded } from "../../charts/scales";
import { type Format, exportJob } from "../../protocol/client";
import type { Units } from "../../protocol/messages";
import { current, useStore } from "../../state/store";
import { amount, axisLabel, shown, told } from "../../units";
import { scaled, words } from "../values";
import { type PanelOf, type Run, chosenRows, parts, valueAt } from "./figures";

interface PanelProps {
  panel: PanelOf;
  run: Run;
  at: number;
  seek: (time: number) => void;
  isFirst: boolean;
}

const MOST_ROWS = 400;

export function SignalPanel({ panel, run, at, seek, isFirst }: PanelProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const time = run.time.data;
  const lines = useMemo(() => [...signals(panel, units), ...stops(panel, run, units)], [panel, run, units]);
  const events = useMemo(() => run.events.map((event) => event.time), [run]);
  const range = useMemo(() => padded(extent(...lines.map((line) => line.values)), 0.06), [lines]);
  const axis = panel.quantity === null ? panel.title.toLowerCase() : axisLabel(units, panel.quantity, SHORT[panel.kind]);
  const figures = () => ({
    columns: ["time [s]", ...panel.channels.map((channel) => channel.label)],
    rows: chosenRows(time.length, MOST_ROWS).map((i) => [told(time[i]), ...panel.channels.map((_, line) => told(lines[line].values[i]))]),
  });
  const now = panel.channels.map(({ label, quantity, values }) => `${label} ${quantity === null ? told(valueAt(time, values.data, at)) : amount(units, quantity, valueAt(time, values.data, at))}`);
  const save = isFirst ? (format: Format) => exportJob(current().jobs.scenario!.result!.id, "scenario", format) : undefined;
  return (
    <Picture title={panel.title} note={now.join(", ")} save={save} figures={figures}>
      <Lines label={`${panel.title} over time`} x={{ values: time, label: "time [s]" }} y={{ label: axis, range }} lines={lines} marks={{ at, events }} height={200} onPick={seek} />
    </Picture>
  );
}

const SHORT: { [kind: string]: string } = { angular_velocity: "speed", twist: "twist", slip: "angle", torque: "torque", done: "" };

function signals(panel: PanelOf, units: Units): Line[] {
  return panel.channels.map(({ label, quantity, values }, i) => ({
    name: label,
    values: quantity === null ? values.data : scaled(values.data, units, quantity),
    colour: i,
    dash: Math.floor(i / 4),
    width: 1.6,
  }));
}

/** Stops as faint lines, of connections whose twist comes anywhere near them. */
function stops(panel: PanelOf, run: Run, units: Units): Line[] {
  if (panel.kind !== "twist") return [];
  return panel.channels.flatMap((channel, i) => {
    const [, place] = parts(channel);
    const most = Math.max(...extent(channel.values.data).map(Math.abs));
    const near = (run.stops[place] ?? []).filter((stop) => Math.abs(stop) < 3 * most);
    return near.map((stop) => ({ name: `${stop > 0 ? "upper" : "lower"} stop of ${words(place)}`, values: new Float64Array(run.time.data.length).fill(shown(units, "relative_angle", stop)), colour: i, dash: 1, faint: true }));
  });
}
