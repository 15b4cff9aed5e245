// Branches over speed: stable ones drawn through, unstable ones dashed, turning points marked, the linear response beside.

import { type ReactNode, useMemo, useState } from "react";
import { type Paper, Plane, pathOf } from "../../charts/plane";
import { Picture } from "../../charts/picture";
import { type Range, extent, padded } from "../../charts/scales";
import { type Look, useLook } from "../../charts/style";
import { type Format, exportJob } from "../../protocol/client";
import type { Units } from "../../protocol/messages";
import { current, useStore } from "../../state/store";
import { amount, axisLabel, shown as inUnits, told } from "../../units";
import { Choose } from "../settings";
import { scaled } from "../values";
import { type BranchLine, type BranchPoint, type Branches, isStable, motionOf, readingsAt, shownOf, slowSpans } from "./figures";

interface PictureProps {
  found: Branches;
  shown: string;
  show: (shown: string) => void;
}

export function BranchPicture({ found, shown, show }: PictureProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const options = shownOf(found);
  const order = options.some(([name]) => name === shown) ? shown : options[0][0];
  const torque = found.torque === "full_load" ? "full load" : amount(units, "torque", found.torque);
  const title = `Branches at ${found.label}${found.gear ? `, gear ${found.gear}` : ""}, ${torque}`;
  const save = (format: Format) => exportJob(current().jobs.branches!.result!.id, "branches", format);
  return (
    <Picture title={title} save={save} figures={() => figuresOf(found, order, units)}>
      <Choose label="Shown" options={options} value={order} put={show} />
      <BranchPlane found={found} order={order} units={units} label={title} />
      <Key />
      <Words found={found} order={order} units={units} />
    </Picture>
  );
}

function BranchPlane({ found, order, units, label }: { found: Branches; order: string; units: Units; label: string }) {
  const [at, see] = useState<number | null>(null);
  const x = useMemo<Range>(() => padded(extent(...found.lines.map((line) => line.speed.data), found.linear.speed.data), 0.01), [found]);
  const y = useMemo<Range>(() => [0, extent(...found.lines.map((line) => line.value[order]?.data ?? []), found.linear.value[order]?.data ?? [])[1] * 1.05 || 1], [found, order]);
  const speeds = x.map((value) => inUnits(units, "speed", value)) as Range;
  const values = y.map((value) => inUnits(units, found.quantity, value)) as Range;
  const kind = order === "swing" ? "half peak-to-peak" : "0-peak";
  const factor = units.speed?.factor ?? 1;
  return (
    <>
      <Plane label={label} height={380} x={{ range: speeds, label: axisLabel(units, "speed", "speed") }} y={{ range: values, label: `${axisLabel(units, found.quantity, found.quantity)}, ${kind}` }} onPoint={(speed) => see(speed * factor)}>
        {(paper) => <Curves paper={paper} found={found} order={order} units={units} at={at} />}
      </Plane>
      <label className="reader">
        <span>Read at</span>
        <input type="range" min={x[0]} max={x[1]} step={(x[1] - x[0]) / 500} value={at ?? x[0]} aria-valuetext={amount(units, "speed", at ?? x[0])} onChange={(event) => see(Number(event.target.value))} />
        <output className="readout">{at === null ? "Point at the picture, or move this slider" : readingText(found, at, order, units)}</output>
      </label>
    </>
  );
}

function readingText(found: Branches, speed: number, order: string, units: Units): string {
  const read = readingsAt(found.lines, speed, order).map(({ line, value }) => `${amount(units, found.quantity, value)} (${motionOf(line)})`);
  return `${amount(units, "speed", speed)}: ${read.join("; ") || "no motion was followed here"}`;
}

interface CurvesProps {
  paper: Paper;
  found: Branches;
  order: string;
  units: Units;
  at: number | null;
}

const SLOW = 1;

function Curves({ paper, found, order, units, at }: CurvesProps) {
  const { look, top, height } = paper;
  const across = (speed: number) => paper.x.place(inUnits(units, "speed", speed));
  const way = (line: Pick<BranchLine, "speed" | "value">) => pathOf(paper, scaled(line.speed.data, units, "speed"), scaled(line.value[order]?.data ?? new Float64Array(), units, found.quantity));
  return (
    <>
      {slowSpans(found.lines).map(([low, high]) => <rect key={low} x={across(low)} width={across(high) - across(low)} y={top} height={height} fill={look.colours[SLOW]} fillOpacity={0.13} />)}
      <path d={way(found.linear)} fill="none" stroke={look.faint} strokeWidth={1} />
      {found.lines.map((line, i) => (
        <path key={i} d={way(line)} fill="none" stroke={look.colours[line.period > 1 ? SLOW : 0]} strokeWidth={isStable(line) ? 2.4 : 1.7} strokeDasharray={isStable(line) ? undefined : "5 4"} />
      ))}
      {found.points.map((point, i) => (
        <g key={i} transform={`translate(${across(point.speed)} ${paper.y.place(inUnits(units, found.quantity, point.value[order]))})`}>
          <title>{pointText(point, found, order, units)}</title>
          <Mark kind={point.kind} stroke={look.ink} fill={look.paper} />
        </g>
      ))}
      {at !== null && <line x1={across(at)} x2={across(at)} y1={top} y2={top + height} stroke={look.faint} strokeDasharray="2 3" />}
    </>
  );
}

/** A triangle where a branch turns back, a disc where the period doubles, a square for any other change. */
function Mark({ kind, stroke, fill }: { kind: string; stroke: string; fill: string }) {
  const shape = kind === "fold" ? "M0 -5.5L5 4H-5Z" : kind === "period doubling" ? "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0" : "M-4 -4H4V4H-4Z";
  return <path d={shape} stroke={stroke} fill={fill} strokeWidth={1.6} />;
}

function Key() {
  const look = useLook();
  return (
    <p className="key">
      {keysOf(look).map(([name, drawn]) => (
        <span key={name}>
          <svg width="26" height="12" viewBox="-13 -6 26 12" aria-hidden="true">{drawn}</svg> {name}
        </span>
      ))}
    </p>
  );
}

function keysOf(look: Look): [string, ReactNode][] {
  const line = (stroke: string, strokeWidth: number, strokeDasharray?: string) => <path d="M-13 0H13" {...{ stroke, strokeWidth, strokeDasharray }} />;
  const mark = (kind: string) => <Mark kind={kind} stroke={look.ink} fill={look.paper} />;
  return [
    ["stable", line(look.colours[0], 2.4)],
    ["unstable", line(look.colours[0], 1.7, "5 4")],
    ["slower than the ignition", line(look.colours[SLOW], 2.4)],
    ["linear", line(look.faint, 1)],
    ["fold", mark("fold")],
    ["period doubling", mark("period doubling")],
  ];
}

function pointText(point: BranchPoint, found: Branches, order: string, units: Units): string {
  return `${point.kind} at ${amount(units, "speed", point.speed)}, ${amount(units, found.quantity, point.value[order])}`;
}

function Words({ found, order, units }: { found: Branches; order: string; units: Units }) {
  const range = ([low, high]: [number, number]) => `${amount(units, "speed", low)} to ${amount(units, "speed", high)}`;
  return (
    <ul className="words">
      {found.points.map((point, i) => <li key={i}>{pointText(point, found, order, units)}</li>)}
      {found.coexisting.map(({ speed }, i) => <li key={`c${i}`}>{`Several stable motions from ${range(speed)}: which one runs depends on how it was begun.`}</li>)}
      {slowSpans(found.lines).map((span) => <li key={`s${span[0]}`}>{`Motion slower than the ignition from ${range(span)} (shaded).`}</li>)}
      {!found.points.length && found.lines.every(isStable) && <li>One stable motion at every speed: no fold and no period doubling.</li>}
    </ul>
  );
}

function figuresOf(found: Branches, order: string, units: Units) {
  const rows = found.lines.flatMap((line) => [...line.speed.data].map((speed, i) => [told(inUnits(units, "speed", speed)), told(inUnits(units, found.quantity, line.value[order].data[i])), motionOf(line), `${line.kind} ${line.branch}`]));
  return { columns: [axisLabel(units, "speed"), axisLabel(units, found.quantity), "motion", "branch"], rows };
}
