// Lines over one axis by uPlot, with idle and range marked, a read-out at the cursor, and lines that can be put away.

import { type KeyboardEvent, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import uPlot from "uplot";
import { told } from "../units";
import { useWidth } from "./size";
import { DASHES, type Look, useLook } from "./style";

export interface Line {
  name: string;
  values: ArrayLike<number>;
  colour: number;
  dash?: number;
  width?: number;
  /** Drawn faintly and left out of legend and read-out: a neighbour of the line that matters. */
  faint?: boolean;
}

export interface Marks {
  idle?: number | null;
  range?: [number, number];
  /** Where the user is: a thin line. */
  at?: number | null;
  /** Instants at which something begins: dashed lines. */
  events?: number[];
}

interface LinesProps {
  label: string;
  x: { values: ArrayLike<number>; label: string };
  /** `free`: the axis need not begin at zero. */
  y: { label: string; range?: [number, number]; log?: boolean; free?: boolean };
  lines: Line[];
  marks?: Marks;
  height: number;
  onPick?: (x: number) => void;
}

/** The marks reach uPlot's drawing by a box, since its options are made once. */
interface Box<T> {
  current: T;
}

function drawMarks(plot: uPlot, marks: Marks, look: Look): void {
  const { ctx, bbox } = plot;
  const across = (value: number) => plot.valToPos(value, "x", true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  if (marks.range) {
    const [left, right] = marks.range.map(across);
    ctx.fillStyle = look.shade;
    ctx.fillRect(left, bbox.top, right - left, bbox.height);
  }
  const events = (marks.events ?? []).map((event) => [event, [2, 4]] as const);
  for (const [value, dash] of [[marks.idle, [6, 4]], [marks.at, []], ...events] as const) {
    if (value === null || value === undefined) continue;
    ctx.strokeStyle = look.faint;
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([...dash]);
    ctx.beginPath();
    ctx.moveTo(across(value), bbox.top);
    ctx.lineTo(across(value), bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

function series(line: Line, look: Look): uPlot.Series {
  const colour = look.colours[line.colour % look.colours.length];
  return {
    label: line.name,
    stroke: line.faint ? `${colour}55` : colour,
    width: line.width ?? (line.faint ? 1 : 2),
    dash: DASHES[(line.dash ?? 0) % DASHES.length],
    points: { show: false },
    spanGaps: false,
  };
}

function axis(label: string, look: Look, size?: number): uPlot.Axis {
  const line = { stroke: look.grid, width: 1 };
  const font = "12px system-ui, sans-serif";
  const values = (_: uPlot, splits: number[]) => splits.map((value) => (value === null ? "" : told(value)));
  return { label, stroke: look.faint, grid: line, ticks: line, font, labelFont: font, labelSize: 20, size, values };
}

/** What uPlot cannot change afterwards; a new plot is made when it differs. */
function shapeOf(lines: Line[]): string {
  return JSON.stringify(lines.map(({ name, colour, dash, width, faint }) => [name, colour, dash, width, faint]));
}

function rangeOf(y: LinesProps["y"]): uPlot.Scale["range"] {
  if (y.range) return () => y.range!;
  return y.log || y.free ? undefined : (_, low, high) => [Math.min(low, 0), high * 1.05 || 1];
}

function optionsOf(props: LinesProps, look: Look, width: number, marks: Box<Marks>, seen: (index: number | null) => void): uPlot.Options {
  const { x, y, lines, height } = props;
  return {
    width,
    height,
    legend: { show: false },
    cursor: { y: false, drag: { x: true, y: false }, points: { size: 7 } },
    scales: {
      x: { time: false },
      y: { distr: y.log ? 3 : 1, range: rangeOf(y) },
    },
    axes: [axis(x.label, look, 34), axis(y.label, look, 58)],
    series: [{}, ...lines.map((line) => series(line, look))],
    hooks: {
      drawClear: [(plot) => drawMarks(plot, marks.current, look)],
      setCursor: [(plot) => seen(plot.cursor.idx ?? null)],
    },
  };
}

function dataOf(x: ArrayLike<number>, lines: Line[]): uPlot.AlignedData {
  return [x, ...lines.map((line) => line.values)] as unknown as uPlot.AlignedData;
}

/** The plot of an element: made once for lines of the same looks, and given new values after that. */
function usePlot(props: LinesProps, look: Look, hidden: ReadonlySet<string>, seen: (index: number | null) => void) {
  const [ref, width] = useWidth<HTMLDivElement>();
  const plot = useRef<uPlot | null>(null);
  const marks = useRef<Marks>(props.marks ?? {});
  const { x, y, lines, height } = props;
  const range = y.range?.join();
  const shape = `${shapeOf(lines)}|${x.label}|${y.label}|${y.log}|${range}|${look.dark}|${height}`;
  marks.current = props.marks ?? {};
  useLayoutEffect(() => {
    if (ref.current === null || width === 0) return undefined;
    const made = new uPlot(optionsOf(props, look, width, marks, seen), dataOf(x.values, lines), ref.current);
    plot.current = made;
    return () => {
      plot.current = null;
      made.destroy();
    };
  }, [shape, width > 0]);
  useLayoutEffect(() => plot.current?.setSize({ width, height }), [width, height]);
  useLayoutEffect(() => plot.current?.setData(dataOf(x.values, lines)), [x.values, lines]);
  useLayoutEffect(() => {
    lines.forEach((line, i) => plot.current?.setSeries(i + 1, { show: !hidden.has(line.name) }));
  }, [hidden, shape, width > 0]);
  useEffect(() => plot.current?.redraw(false), [props.marks?.at, props.marks?.idle]);
  return { ref, plot };
}

export function Lines(props: LinesProps) {
  const look = useLook();
  const [hidden, hide] = useState<ReadonlySet<string>>(new Set());
  const [at, see] = useState<number | null>(null);
  const { ref, plot } = usePlot(props, look, hidden, see);
  const { x, lines, height, label, onPick } = props;
  const shown = useMemo(() => lines.filter((line) => !line.faint), [lines]);
  const toggle = (name: string) => hide((names) => new Set(names.has(name) ? [...names].filter((other) => other !== name) : [...names, name]));
  const move = (event: KeyboardEvent) => {
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10, Home: -Infinity, End: Infinity }[event.key];
    if (event.key === "Enter" && at !== null) onPick?.(x.values[at]);
    if (steps === undefined || plot.current === null) return;
    event.preventDefault();
    const next = Math.min(Math.max((at ?? 0) + steps, 0), x.values.length - 1);
    plot.current.setCursor({ left: plot.current.valToPos(x.values[next], "x"), top: 10 });
  };
  return (
    <div className="lines">
      <div ref={ref} className="plot" data-height={height} role="img" aria-label={label} tabIndex={0} onKeyDown={move} />
      <Legend lines={shown} hidden={hidden} toggle={toggle} at={at} x={x} look={look} />
    </div>
  );
}

interface LegendProps {
  lines: Line[];
  hidden: ReadonlySet<string>;
  toggle: (name: string) => void;
  at: number | null;
  x: LinesProps["x"];
  look: Look;
}

function Legend({ lines, hidden, toggle, at, x, look }: LegendProps) {
  return (
    <div className="legend">
      <output className="readout">{at === null || at >= x.values.length ? "Point at the picture, or use ← →" : `${x.label}: ${told(x.values[at])}`}</output>
      {lines.map((line) => (
        <button key={line.name} type="button" aria-pressed={!hidden.has(line.name)} onClick={() => toggle(line.name)}>
          <svg width="22" height="8" aria-hidden="true">
            <line x1="0" x2="22" y1="4" y2="4" stroke={look.colours[line.colour % look.colours.length]} strokeWidth="2.5" strokeDasharray={DASHES[(line.dash ?? 0) % DASHES.length].join(" ")} />
          </svg>
          {line.name}
          {at !== null && at < x.values.length && <b>{told(line.values[at])}</b>}
        </button>
      ))}
    </div>
  );
}
