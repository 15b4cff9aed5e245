// What the server tells of branches of periodic motion, and what is read from them.

import type { Grid } from "../../protocol/messages";

export interface BranchLine {
  branch: number;
  kind: string;
  period: number;
  stable: Grid;
  speed: Grid;
  value: { [order: string]: Grid };
}

export interface BranchPoint {
  kind: string;
  speed: number;
  branch: number;
  value: { [order: string]: number };
}

export interface Branches {
  gear: string;
  torque: number | "full_load";
  place: string;
  label: string;
  quantity: string;
  orders: number[];
  lines: BranchLine[];
  points: BranchPoint[];
  coexisting: { speed: [number, number]; branches: number[] }[];
  linear: { speed: Grid; value: { [order: string]: Grid } };
}

/** Lines are stable or unstable throughout. */
export function isStable(line: BranchLine): boolean {
  return line.stable.data[0] === 1;
}

/** What can be looked at: orders, and the swing of all together. */
export function shownOf(found: Branches): [name: string, label: string][] {
  const orders = found.orders.map((order): [string, string] => [String(order), `order ${order}, 0-peak`]);
  return [...orders, ["swing", "all orders together, half peak-to-peak"]];
}

export type Span = [number, number];

/** Ranges of speed with a stable motion that repeats only after several ignitions, joined where they meet. */
export function slowSpans(lines: BranchLine[]): Span[] {
  const spans = lines
    .filter((line) => line.period > 1 && isStable(line))
    .map(({ speed: { data } }): Span => [data.reduce((a, b) => Math.min(a, b), Infinity), data.reduce((a, b) => Math.max(a, b), -Infinity)])
    .sort((a, b) => a[0] - b[0]);
  const joined: Span[] = [];
  for (const [low, high] of spans) {
    const last = joined.at(-1);
    if (last && low <= last[1]) last[1] = Math.max(last[1], high);
    else joined.push([low, high]);
  }
  return joined;
}

export interface Reading {
  line: BranchLine;
  value: number;
}

/** Every motion at one speed: a line that turns back is met several times. */
export function readingsAt(lines: BranchLine[], speed: number, order: string): Reading[] {
  return lines.flatMap((line) => {
    const [xs, ys] = [line.speed.data, line.value[order]?.data];
    const met: Reading[] = [];
    for (let i = 0; ys && i + 1 < xs.length; i++) {
      const [from, to] = [xs[i], xs[i + 1]];
      // Half-open, so that a point between two stretches is met once.
      if (from === to || !((from <= speed && speed < to) || (to < speed && speed <= from) || (i + 2 === xs.length && speed === to))) continue;
      met.push({ line, value: ys[i] + ((speed - from) / (to - from)) * (ys[i + 1] - ys[i]) });
    }
    return met;
  });
}

/** What a motion is called: "stable, every second ignition". */
export function motionOf(line: BranchLine): string {
  const stability = isStable(line) ? "stable" : "unstable";
  return line.period === 1 ? stability : `${stability}, repeats after ${line.period} ignitions`;
}
