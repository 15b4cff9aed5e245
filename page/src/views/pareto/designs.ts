// Designs of a finished sweep or search: what can be an axis, which are bettered by none, and where a pointer is.

import type { Grid } from "../../protocol/messages";

export interface Parameter {
  path: string;
  label: string;
  values: Grid | string[];
}

export interface Criterion {
  name: string;
  label: string;
  quantity: string;
  better: "less" | "more";
  objective: boolean;
  limits: [number | null, number | null] | null;
  values: Grid;
}

export interface Front {
  name: string;
  designs: number;
  /** Of very many designs only some are sent. */
  all: number;
  parameters: Parameter[];
  criteria: Criterion[];
  on_front: Grid | null;
  within: Grid | null;
  role: string[] | null;
}

/** A criterion or a numeric parameter that designs are laid out along. */
export interface Dimension {
  key: string;
  label: string;
  /** Null where the page does not know it. */
  quantity: string | null;
  values: Float64Array;
  /** 1 where less is better, -1 where more is, 0 for a parameter. */
  sense: -1 | 0 | 1;
  limits: number[];
}

export function dimensionsOf(front: Front, quantityOf: (path: string) => string | null): Dimension[] {
  const criteria = front.criteria.map((criterion): Dimension => {
    const limits = (criterion.limits ?? [null, null]).filter((limit) => limit !== null);
    return { key: `criterion ${criterion.name}`, label: criterion.label, quantity: criterion.quantity, values: criterion.values.data, sense: criterion.better === "less" ? 1 : -1, limits };
  });
  const parameters = front.parameters.flatMap(({ path, label, values }): Dimension[] =>
    Array.isArray(values) ? [] : [{ key: `parameter ${path}`, label, quantity: quantityOf(path), values: values.data, sense: 0, limits: [] }],
  );
  return [...criteria, ...parameters];
}

/** The axes that were chosen, else the first two objectives, else whatever comes first. */
export function axesOf(front: Front, dimensions: Dimension[], x: unknown, y: unknown): [Dimension, Dimension] {
  const objectives = front.criteria.filter((criterion) => criterion.objective).map(({ name }) => `criterion ${name}`);
  const usual = [...objectives, ...dimensions.map(({ key }) => key)];
  const named = (key: unknown) => dimensions.find((dimension) => dimension.key === key);
  const first = named(x) ?? named(usual[0])!;
  return [first, named(y) ?? named(usual.find((key) => key !== first.key)) ?? first];
}

export function isWithin(front: Front, index: number): boolean {
  return front.within === null || front.within.data[index] === 1;
}

export function isOnFront(front: Front, index: number): boolean {
  return front.on_front !== null && front.on_front.data[index] === 1;
}

/** Designs within limits that no other one betters along both axes, from the best along x on; none where an axis has no better end. */
export function bettered(x: Dimension, y: Dimension, allowed: (index: number) => boolean): number[] {
  if (x.sense === 0 || y.sense === 0 || x.key === y.key) return [];
  const known = Array.from(x.values.keys()).filter((i) => allowed(i) && Number.isFinite(x.values[i] + y.values[i]));
  known.sort((a, b) => x.sense * (x.values[a] - x.values[b]) || y.sense * (y.values[a] - y.values[b]));
  let best = Infinity;
  return known.filter((i) => {
    if (!(y.sense * y.values[i] < best)) return false;
    best = y.sense * y.values[i];
    return true;
  });
}

/** The edge of what the designs on a front better: level to the next one's x, then over to its y. */
export function staircase(front: number[], x: Float64Array, y: Float64Array): [number[], number[]] {
  const [xs, ys]: [number[], number[]] = [[], []];
  front.forEach((index, i) => {
    if (i > 0) {
      xs.push(x[index]);
      ys.push(y[front[i - 1]]);
    }
    xs.push(x[index]);
    ys.push(y[index]);
  });
  return [xs, ys];
}

/** The design that lies next to a point on the paper, not farther than `reach`; null where there is none. */
export function designAt(px: Float64Array, py: Float64Array, at: [number, number], reach: number): number | null {
  let found: number | null = null;
  let least = reach * reach;
  for (let i = 0; i < px.length; i++) {
    const distance = (px[i] - at[0]) ** 2 + (py[i] - at[1]) ** 2;
    if (distance <= least) [found, least] = [i, distance];
  }
  return found;
}

/** Where arrow keys lead: to the neighbour on a front, which from elsewhere begins at its nearer end. */
export function stepAlong(front: number[], from: number | null, step: number): number | null {
  if (!front.length) return null;
  const at = from === null ? -1 : front.indexOf(from);
  if (at < 0) return step > 0 ? front[0] : front[front.length - 1];
  return front[Math.min(Math.max(at + step, 0), front.length - 1)];
}

/** Roles worth a label; "before gradients" and the like would crowd the picture. */
export function labelled(front: Front): { index: number; text: string }[] {
  return (front.role ?? []).flatMap((role, index) => (role && !role.includes(",") ? [{ index, text: role.replaceAll("_", " ") }] : []));
}
