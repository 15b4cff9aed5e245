// How the line is wound up at each instant: twists of its connections added up along the chain, beginning at the crank.

import type { ChainLink, Grid } from "../../protocol/messages";

/** Angles of nodes beyond their mean rotation, by node and time; a ratio tells how fast a node turns to the crank. */
export interface Moved {
  crank: string;
  nodes: string[];
  speed_ratio: Grid;
  angle: Grid;
}

export interface Windup {
  nodes: string[];
  /** By node and time [rad]; each part of the line that a slipping connection cuts off begins at zero. */
  angle: Float64Array[];
  links: [from: number, to: number][];
  /** Names of connections that turn through. */
  cut: string[];
}

const TURN = 2 * Math.PI;

/** The twist between two nodes that gears may lie between: on the side that turns slower. */
function twistOf({ angle, speed_ratio }: Moved, a: number, b: number): Float64Array {
  const count = angle.shape[1];
  const [ra, rb] = [speed_ratio.data[a], speed_ratio.data[b]];
  const slower = Math.min(Math.abs(ra), Math.abs(rb));
  return Float64Array.from({ length: count }, (_, i) => (angle.data[b * count + i] / rb - angle.data[a * count + i] / ra) * slower);
}

/** Along the links of the chain, whose nodes alone are told: a lining that only a run has belongs to no link of the drawing. */
export function windupOf(moved: Moved, links: ChainLink[]): Windup {
  const place = new Map(moved.nodes.map((name, index) => [name, index]));
  const known = links.flatMap(({ name, nodes }) => nodes.slice(1).map((other) => ({ name, a: place.get(nodes[0]), b: place.get(other) })));
  const unreached = new Set<number>();
  const found: Windup = { nodes: moved.nodes, angle: moved.nodes.map(() => new Float64Array(0)), links: [], cut: [] };
  const begin = place.get(moved.crank) ?? 0;
  for (const start of [begin, ...moved.nodes.keys()]) {
    if (found.angle[start].length) continue;
    found.angle[start] = new Float64Array(moved.angle.shape[1]);
    unreached.add(start);
    for (const waiting = [start]; waiting.length; ) {
      const at = waiting.pop()!;
      for (const { name, a, b } of known) {
        if (a === undefined || b === undefined || (a !== at && b !== at)) continue;
        const next = a === at ? b : a;
        if (found.angle[next].length) continue;
        const twist = twistOf(moved, at, next);
        if (twist.some((value) => Math.abs(value) > TURN)) {
          if (!found.cut.includes(name)) found.cut.push(name);
          continue;
        }
        found.angle[next] = twist.map((value, i) => value + found.angle[at][i]);
        found.links.push([at, next]);
        unreached.delete(start);
        waiting.push(next);
      }
    }
  }
  return without(found, unreached);
}

/** Nodes that are linked to none are left out, the others numbered anew. */
function without(found: Windup, unreached: Set<number>): Windup {
  const kept = [...found.nodes.keys()].filter((node) => !unreached.has(node));
  const number = new Map(kept.map((node, index) => [node, index]));
  return {
    nodes: kept.map((node) => found.nodes[node]),
    angle: kept.map((node) => found.angle[node]),
    links: found.links.map(([a, b]) => [number.get(a)!, number.get(b)!]),
    cut: found.cut,
  };
}
