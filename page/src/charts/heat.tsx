// An amplitude over two axes in colour: a canvas behind the axes of a plane, with a read-out under the cursor.

import { type KeyboardEvent, type ReactNode, useLayoutEffect, useRef, useState } from "react";
import type { ColourMap } from "./colourmaps";
import { type Axis, type Paper, Plane } from "./plane";
import { type Range, nearest } from "./scales";

export interface Colours {
  map: ColourMap;
  /** Logarithmic, between these values. */
  range: Range;
}

interface HeatProps {
  label: string;
  x: Axis & { values: ArrayLike<number> };
  y: Axis & { values: ArrayLike<number> };
  /** Row by row of y, each along x; what is no number stays blank. */
  values: ArrayLike<number>;
  colours: Colours;
  height: number;
  over?: (paper: Paper) => ReactNode;
  /** What is told of one cell. */
  read: (row: number, column: number) => string;
  onPick?: (row: number, column: number) => void;
}

interface Cell {
  row: number;
  column: number;
}

export function Heat({ label, x, y, values, colours, height, over, read, onPick }: HeatProps) {
  const [at, see] = useState<Cell | null>(null);
  const pointed = (px: number, py: number) => see({ row: nearest(y.values, py), column: nearest(x.values, px) });
  const pressed = (event: KeyboardEvent) => {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
    if (event.key === "Enter" && at) onPick?.(at.row, at.column);
    if (!step) return;
    event.preventDefault();
    const from = at ?? { row: 0, column: 0 };
    const clamped = (value: number, size: number) => Math.min(Math.max(value, 0), size - 1);
    see({ row: clamped(from.row + step[0], y.values.length), column: clamped(from.column + step[1], x.values.length) });
  };
  return (
    <div className="heat" tabIndex={0} role="group" aria-label={`${label}; arrow keys move the read-out`} onKeyDown={pressed} onClick={() => at && onPick?.(at.row, at.column)}>
      <Plane label={label} x={x} y={y} height={height} onPoint={pointed} onLeave={() => see(null)} behind={(paper) => <Cells paper={paper} x={x.values} y={y.values} values={values} colours={colours} />}>
        {(paper) => (
          <>
            {over?.(paper)}
            {at && <Cross paper={paper} x={x.values[at.column]} y={y.values[at.row]} />}
          </>
        )}
      </Plane>
      <output className="readout">{at ? read(at.row, at.column) : "\u00a0"}</output>
    </div>
  );
}

function Cross({ paper, x, y }: { paper: Paper; x: number; y: number }) {
  const { left, top, width, height } = paper;
  const way = `M${paper.x.place(x)} ${top}v${height}M${left} ${paper.y.place(y)}h${width}`;
  return (
    <g pointerEvents="none">
      <path d={way} stroke="#000" strokeOpacity={0.45} strokeWidth={3} />
      <path d={way} stroke="#fff" strokeWidth={1} />
    </g>
  );
}

interface CellsProps {
  paper: Paper;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  values: ArrayLike<number>;
  colours: Colours;
}

/** The values as a picture of one pixel a cell, drawn large with colours running between the cells. */
function Cells({ paper, x, y, values, colours }: CellsProps) {
  const ref = useRef<HTMLCanvasElement>(null);
  const { left, top, width, height } = paper;
  useLayoutEffect(() => {
    const canvas = ref.current;
    const drawn = canvas?.getContext("2d");
    if (!canvas || !drawn) return;
    const density = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
    Object.assign(canvas.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
    const [from, to] = [edges(x), edges(y)];
    const place = (value: number) => (paper.x.place(value) - left) * density;
    const rise = (value: number) => (paper.y.place(value) - top) * density;
    drawn.imageSmoothingQuality = "high";
    drawn.drawImage(pixels(x.length, y.length, values, colours), place(from[0]), rise(to[1]), place(from[1]) - place(from[0]), rise(to[0]) - rise(to[1]));
  }, [paper, x, y, values, colours]);
  return <canvas ref={ref} aria-hidden="true" />;
}

/** The outer edges of evenly spaced cells about their middles. */
function edges(middles: ArrayLike<number>): Range {
  const last = middles.length - 1;
  const half = last ? (middles[last] - middles[0]) / last / 2 : 0.5;
  return [middles[0] - half, middles[last] + half];
}

const SHADES = 512;
const TABLES = new Map<ColourMap, Uint32Array>();

/** A colour map as a table of pixels, for tens of thousands of them at a time. */
function shadesOf(map: ColourMap): Uint32Array {
  const known = TABLES.get(map);
  if (known) return known;
  const table = new Uint32Array(SHADES);
  const parts = new Uint8Array(table.buffer);
  for (let i = 0; i < SHADES; i++) parts.set([...map(i / (SHADES - 1)), 255], 4 * i);
  TABLES.set(map, table);
  return table;
}

function pixels(columns: number, rows: number, values: ArrayLike<number>, { map, range }: Colours): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [columns, rows];
  const drawn = canvas.getContext("2d")!;
  const image = drawn.createImageData(columns, rows);
  const [shades, cells] = [shadesOf(map), new Uint32Array(image.data.buffer)];
  const low = Math.log(range[0]);
  const scale = (SHADES - 1) / (Math.log(range[1]) - low || 1);
  for (let i = 0; i < columns * rows; i++) {
    if (!(values[i] > 0)) continue;
    const shade = Math.min(Math.max(Math.round((Math.log(values[i]) - low) * scale), 0), SHADES - 1);
    cells[(rows - 1 - Math.floor(i / columns)) * columns + (i % columns)] = shades[shade];
  }
  drawn.putImageData(image, 0, 0);
  return canvas;
}
