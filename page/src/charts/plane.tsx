// A plane with axes, drawn as SVG: for curves that turn back, points, bars, and axes about a canvas.

import { type PointerEvent, type ReactNode, useMemo } from "react";
import { told } from "../units";
import { type Range, type Scale, linear, ticks } from "./scales";
import { useWidth } from "./size";
import { type Look, useLook } from "./style";

export interface Axis {
  range: Range;
  label: string;
  /** Marked values with their words; round values by default. */
  marks?: [number, string][];
}

export interface Paper {
  x: Scale;
  y: Scale;
  left: number;
  top: number;
  width: number;
  height: number;
  look: Look;
}

interface PlaneProps {
  label: string;
  x: Axis;
  y: Axis;
  height: number;
  /** Words instead of numbers below the axis need more room and stand aslant. */
  slanted?: boolean;
  children: (paper: Paper) => ReactNode;
  /** What lies below the axes, as a canvas. */
  behind?: (paper: Paper) => ReactNode;
  /** What lies above them, as a moving layer. */
  before?: (paper: Paper) => ReactNode;
  onPoint?: (x: number, y: number) => void;
  onLeave?: () => void;
}

const LEFT = 62;
const RIGHT = 14;
const TOP = 10;
const BOTTOM = 42;
const SLANTED = 90;

export function Plane({ label, x, y, height, slanted = false, children, behind, before, onPoint, onLeave }: PlaneProps) {
  const [ref, width] = useWidth<HTMLDivElement>();
  const look = useLook();
  const paper = useMemo(() => paperOf(x.range, y.range, width, height - (slanted ? SLANTED : BOTTOM), look), [x.range[0], x.range[1], y.range[0], y.range[1], width, height, slanted, look]);
  const pointed = (event: PointerEvent<SVGSVGElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    onPoint?.(paper.x.value(event.clientX - box.left), paper.y.value(event.clientY - box.top));
  };
  return (
    <div ref={ref} className="plane" data-height={height}>
      {width > 0 && (
        <>
          {behind?.(paper)}
          <svg role="img" aria-label={label} width={width} height={height} onPointerMove={onPoint && pointed} onPointerDown={onPoint && pointed} onPointerLeave={onLeave}>
            <Axes paper={paper} x={x} y={y} grid={behind === undefined} slanted={slanted} />
            {children(paper)}
          </svg>
          {before?.(paper)}
        </>
      )}
    </div>
  );
}

function paperOf(x: Range, y: Range, width: number, height: number, look: Look): Paper {
  const inner = { left: LEFT, top: TOP, width: Math.max(width - LEFT - RIGHT, 10), height: height - TOP };
  return {
    ...inner,
    look,
    x: linear(x, [inner.left, inner.left + inner.width]),
    y: linear(y, [inner.top + inner.height, inner.top]),
  };
}

function marksOf(axis: Axis, size: number): [number, string][] {
  return axis.marks ?? ticks(axis.range, size).map((value) => [value, told(value)]);
}

interface AxesProps {
  paper: Paper;
  x: Axis;
  y: Axis;
  grid: boolean;
  slanted: boolean;
}

function Axes({ paper, x, y, grid, slanted }: AxesProps) {
  const { left, top, width, height, look } = paper;
  const bottom = top + height;
  return (
    <g className="axes" fill={look.faint} stroke="none">
      {marksOf(x, width / 65).map(([value, text]) => (
        <g key={value}>
          {grid && <line x1={paper.x.place(value)} x2={paper.x.place(value)} y1={top} y2={bottom} stroke={look.grid} />}
          <text textAnchor={slanted ? "start" : "middle"} transform={`translate(${paper.x.place(value)} ${bottom + 15})${slanted ? " rotate(50)" : ""}`}>{text}</text>
        </g>
      ))}
      {marksOf(y, height / 45).map(([value, text]) => (
        <g key={value}>
          {grid && <line x1={left} x2={left + width} y1={paper.y.place(value)} y2={paper.y.place(value)} stroke={look.grid} />}
          <text x={left - 6} y={paper.y.place(value) + 4} textAnchor="end">{text}</text>
        </g>
      ))}
      <text className="name" x={left + width / 2} y={bottom + 34} textAnchor="middle">{x.label}</text>
      <text className="name" transform={`translate(13 ${top + height / 2}) rotate(-90)`} textAnchor="middle">{y.label}</text>
    </g>
  );
}

/** The way of a curve through the plane; it breaks off where there is no number. */
export function pathOf(paper: Paper, xs: ArrayLike<number>, ys: ArrayLike<number>): string {
  let path = "";
  let pen = "M";
  for (let i = 0; i < xs.length; i++) {
    if (!Number.isFinite(xs[i] + ys[i])) {
      pen = "M";
      continue;
    }
    path += `${pen}${paper.x.place(xs[i]).toFixed(1)} ${paper.y.place(ys[i]).toFixed(1)}`;
    pen = "L";
  }
  return path;
}
