// The chain in motion: how far each disc is turned against the crankshaft at the player's instant.

import { useMemo } from "react";
import { type Paper, Plane } from "../../charts/plane";
import { extent, nearest, padded } from "../../charts/scales";
import type { ChainNode, Units } from "../../protocol/messages";
import { useStore } from "../../state/store";
import { axisLabel, shown } from "../../units";
import { words } from "../values";
import type { Run } from "./figures";
import { type Windup, windupOf } from "./windup";

const NONE: ChainNode[] = [];

export function Motion({ run, time }: { run: Run; time: number }) {
  const units = useStore((state) => state.start?.units ?? {});
  const links = useStore((state) => state.model?.chain.links);
  const discs = useStore((state) => state.model?.chain.nodes) ?? NONE;
  const found = useMemo(() => run.moved && windupOf(run.moved, links ?? []), [run, links]);
  const range = useMemo(() => found && padded(extent(...found.angle).map((value) => shown(units, "relative_angle", value)) as [number, number], 0.08), [found, units]);
  if (!found || !range || found.links.length === 0) return null;
  const marks = found.nodes.map((name, index): [number, string] => [index, words(name)]);
  const title = `The line wound up against ${words(run.moved!.crank)}, gears taken out`;
  return (
    <div className="motion">
      <h4>{title}</h4>
      <Plane label={`${title}; the dials and signals tell the same in figures`} height={300} slanted x={{ range: [-0.6, found.nodes.length - 0.4], label: "", marks }} y={{ range, label: axisLabel(units, "relative_angle", "angle") }}>
        {(paper) => <Line paper={paper} found={found} at={nearest(run.time.data, time)} units={units} discs={discs} />}
      </Plane>
      {found.cut.length > 0 && <p><small>{`Turned through: ${found.cut.map(words).join(", ")}; what lies behind begins at nothing again.`}</small></p>}
    </div>
  );
}

interface LineProps {
  paper: Paper;
  found: Windup;
  at: number;
  units: Units;
  discs: ChainNode[];
}

const TALLEST = 13;

function Line({ paper, found, at, units, discs }: LineProps) {
  const { look } = paper;
  const place = (node: number): [number, number] => [paper.x.place(node), paper.y.place(shown(units, "relative_angle", found.angle[node][at]))];
  const heights = useMemo(() => heightsOf(found.nodes, discs), [found, discs]);
  const bands = useMemo(() => found.angle.map((values) => extent(values).map((value) => shown(units, "relative_angle", value))), [found, units]);
  return (
    <>
      {bands.map(([low, high], node) => <rect key={node} x={paper.x.place(node) - 6} width={12} y={paper.y.place(high)} height={Math.max(paper.y.place(low) - paper.y.place(high), 1)} fill={look.colours[0]} fillOpacity={0.16} />)}
      {found.links.map(([a, b]) => <path key={`${a} ${b}`} d={`M${place(a).join(" ")}L${place(b).join(" ")}`} stroke={look.ink} strokeWidth={1.6} />)}
      {found.nodes.map((name, node) => <rect key={name} x={place(node)[0] - 5} width={10} y={place(node)[1] - heights[node]} height={2 * heights[node]} rx={2} fill={look.colours[0]} />)}
    </>
  );
}

/** Half the height of each disc, by the fourth root of its inertia as in the drawing of the machine. */
function heightsOf(nodes: string[], discs: ChainNode[]): number[] {
  const roots = nodes.map((name) => Math.max(discs.find((disc) => disc.name === name)?.inertia ?? 0, 0) ** 0.25);
  const largest = Math.max(...roots, 1e-9);
  return roots.map((root) => Math.max((TALLEST * root) / largest, 3));
}
