// Designs as points over two of their figures: canvas for the many, SVG for the front and what is told.

import { type KeyboardEvent, useLayoutEffect, useMemo, useRef } from "react";
import { type Paper, Plane, pathOf } from "../../charts/plane";
import { type Range, extent, padded } from "../../charts/scales";
import type { Look } from "../../charts/style";
import { type Dimension, type Front, bettered, designAt, isOnFront, isWithin, labelled, staircase, stepAlong } from "./designs";

/** A dimension in the unit in which it is shown. */
export interface Shown extends Dimension {
  axis: string;
}

interface ScatterProps {
  front: Front;
  x: Shown;
  y: Shown;
  reach: Reach;
  chosen: number | null;
  hovered: number | null;
  choose: (index: number) => void;
  hover: (index: number | null) => void;
}

/** Which designs the axes reach to. */
export type Reach = "front" | "within" | "all";

const NEAR = 18;

export function Scatter({ front, x, y, reach, chosen, hovered, choose, hover }: ScatterProps) {
  const best = useMemo(() => bettered(x, y, (index) => isWithin(front, index)), [front, x, y]);
  const ranges = useMemo(() => [rangeOf(front, x, reach), rangeOf(front, y, reach)], [front, x, y, reach]);
  const paperNow = useRef<Paper | null>(null);
  const pointed = (px: number, py: number) => {
    const paper = paperNow.current;
    if (paper) hover(designAt(x.values.map(paper.x.place), y.values.map(paper.y.place), [paper.x.place(px), paper.y.place(py)], NEAR));
  };
  const pressed = (event: KeyboardEvent) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const next = stepAlong(best.length ? best : [...x.values.keys()], chosen, step);
    if (next !== null) choose(next);
  };
  const label = `${y.label} over ${x.label}, ${front.designs} designs`;
  return (
    <div className="scatter" tabIndex={0} role="group" aria-label={`${label}; arrow keys walk along the front`} onKeyDown={pressed} onClick={() => hovered !== null && choose(hovered)}>
      <Plane label={label} height={430} x={{ range: ranges[0], label: x.axis }} y={{ range: ranges[1], label: y.axis }} onPoint={pointed} onLeave={() => hover(null)} behind={(paper) => <Points paper={paper} front={front} x={x} y={y} />}>
        {(paper) => {
          paperNow.current = paper;
          return <Over paper={paper} front={front} x={x} y={y} best={best} chosen={chosen} hovered={hovered} />;
        }}
      </Plane>
    </div>
  );
}

/** Values that say how far an axis reaches: a search tries designs far from what is worth a look. */
function rangeOf(front: Front, { values, limits }: Shown, reach: Reach): Range {
  const named = new Set(labelled(front).map(({ index }) => index));
  const counts = (index: number) => reach === "all" || (reach === "within" ? isWithin(front, index) : isOnFront(front, index) || named.has(index));
  const counted = values.filter((value, index) => Number.isFinite(value) && counts(index));
  return padded(extent(counted.length ? counted : values, reach === "all" ? limits : []), reach === "front" ? 0.2 : 0.06);
}

const MANY = 3000;

/** All designs: discs within limits, paler crosses beyond. */
function Points({ paper, front, x, y }: { paper: Paper; front: Front; x: Shown; y: Shown }) {
  const ref = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    const canvas = ref.current;
    const drawn = canvas?.getContext("2d");
    if (!canvas || !drawn) return;
    const density = window.devicePixelRatio || 1;
    const { left, top, width, height, look } = paper;
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
    Object.assign(canvas.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
    drawn.setTransform(density, 0, 0, density, -left * density, -top * density);
    drawGroups(drawn, paper, front, x, y, look);
  }, [paper, front, x, y]);
  return <canvas ref={ref} aria-hidden="true" />;
}

function drawGroups(drawn: CanvasRenderingContext2D, paper: Paper, front: Front, x: Shown, y: Shown, look: Look): void {
  const size = x.values.length > MANY ? 1.7 : 3;
  const [inside, beyond] = [new Path2D(), new Path2D()];
  for (let i = 0; i < x.values.length; i++) {
    const [px, py] = [paper.x.place(x.values[i]), paper.y.place(y.values[i])];
    if (!Number.isFinite(px + py)) continue;
    if (isWithin(front, i)) {
      inside.moveTo(px + size, py);
      inside.arc(px, py, size, 0, 2 * Math.PI);
    } else {
      beyond.moveTo(px - size, py - size);
      beyond.lineTo(px + size, py + size);
      beyond.moveTo(px - size, py + size);
      beyond.lineTo(px + size, py - size);
    }
  }
  drawn.strokeStyle = look.faint;
  drawn.globalAlpha = 0.55;
  drawn.stroke(beyond);
  drawn.fillStyle = look.colours[0];
  drawn.globalAlpha = 0.7;
  drawn.fill(inside);
}

interface OverProps {
  paper: Paper;
  front: Front;
  x: Shown;
  y: Shown;
  best: number[];
  chosen: number | null;
  hovered: number | null;
}

const DIAMOND = "M0 -5.5L5.5 0L0 5.5L-5.5 0Z";

function Over({ paper, front, x, y, best, chosen, hovered }: OverProps) {
  const { look, left, top, width, height } = paper;
  const place = (index: number): [number, number] => [paper.x.place(x.values[index]), paper.y.place(y.values[index])];
  const isSeen = (index: number) => Number.isFinite(x.values[index] + y.values[index]);
  const onFront = useMemo(() => [...x.values.keys()].filter((index) => isOnFront(front, index)), [front, x]);
  const [xs, ys] = useMemo(() => staircase(best, x.values, y.values), [best, x, y]);
  const clip = { clipPath: "url(#front-clip)" };
  const ring = (index: number | null, radius: number) => index !== null && isSeen(index) && <circle cx={place(index)[0]} cy={place(index)[1]} r={radius} fill="none" stroke={look.ink} strokeWidth={2} />;
  return (
    <>
      <clipPath id="front-clip"><rect x={left} y={top} width={width} height={height} /></clipPath>
      <rect x={left} y={top} width={width} height={height} fill="none" stroke={look.grid} />
      {x.limits.map((limit) => <line key={`x${limit}`} x1={paper.x.place(limit)} x2={paper.x.place(limit)} y1={top} y2={top + height} stroke={look.colours[3]} strokeDasharray="7 4" {...clip}><title>limit</title></line>)}
      {y.limits.map((limit) => <line key={`y${limit}`} x1={left} x2={left + width} y1={paper.y.place(limit)} y2={paper.y.place(limit)} stroke={look.colours[3]} strokeDasharray="7 4" {...clip}><title>limit</title></line>)}
      <path d={pathOf(paper, xs, ys)} fill="none" stroke={look.colours[1]} strokeWidth={1.6} {...clip} />
      <g {...clip}>
        {onFront.filter(isSeen).map((index) => <path key={index} d={DIAMOND} transform={`translate(${place(index).join(" ")})`} fill={look.colours[1]} stroke={look.paper} />)}
        {ring(hovered, 7)}
        {ring(chosen, 9)}
      </g>
      <Labels paper={paper} front={front} place={place} />
    </>
  );
}

const LINE = 15;
/** As attributes, which go along into a saved picture. */
const LABEL = { fontSize: 12, paintOrder: "stroke", strokeWidth: 3, strokeLinejoin: "round" } as const;

/** Names of designs beside their points, moved down where they would stand on one another. */
function Labels({ paper, front, place }: { paper: Paper; front: Front; place: (index: number) => [number, number] }) {
  const { look, left, top, width, height } = paper;
  const set: [number, number][] = [];
  return labelled(front).map(({ index, text }) => {
    const [x, y] = place(index);
    if (!(x >= left && x <= left + width && y >= top && y <= top + height)) return null;
    const isRight = x > left + width - 130;
    let at = y - 8;
    while (set.some(([otherX, otherY]) => Math.abs(otherX - x) < 110 && Math.abs(otherY - at) < LINE)) at += LINE;
    set.push([x, at]);
    return (
      <g key={index}>
        <circle cx={x} cy={y} r={6} fill="none" stroke={look.ink} />
        <text x={x + (isRight ? -10 : 10)} y={at} textAnchor={isRight ? "end" : "start"} {...LABEL} fill={look.ink} stroke={look.paper}>{text}</text>
      </g>
    );
  });
}
