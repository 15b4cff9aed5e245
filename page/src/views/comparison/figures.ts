// Criteria of several designs side by side: which is best, and how far the others are from a reference.

export interface Criterion {
  name: string;
  label: string;
  quantity: string;
  value: number;
  better: "less" | "more";
}

export interface Row {
  name: string;
  label: string;
  quantity: string;
  /** By design; null where a design has no such figure. */
  values: (number | null)[];
  /** Relative to the reference design's value; null where that is nothing. */
  differences: (number | null)[];
  best: boolean[];
}

/** A row for each criterion that any design has, in the order of their first appearance. */
export function rowsOf(designs: (Criterion[] | null)[], reference: number): Row[] {
  const listed = new Map<string, Criterion>();
  for (const criterion of designs.flatMap((criteria) => criteria ?? [])) if (!listed.has(criterion.name)) listed.set(criterion.name, criterion);
  return [...listed.values()].map(({ name, label, quantity, better }) => {
    const values = designs.map((criteria) => criteria?.find((other) => other.name === name)?.value ?? null);
    return { name, label, quantity, values, differences: values.map((value) => relative(value, values[reference])), best: bestOf(values, better) };
  });
}

/** What may be negative, as the way left to a stop, has no per cents there. */
function relative(value: number | null, reference: number | null): number | null {
  if (value === null || reference === null || !(reference > 0) || !(value >= 0) || !Number.isFinite(value)) return null;
  return (value - reference) / reference;
}

/** No design is best where all are alike, or where only one has the figure. */
function bestOf(values: (number | null)[], better: "less" | "more"): boolean[] {
  const sign = better === "less" ? 1 : -1;
  const known = values.filter((value): value is number => value !== null && Number.isFinite(value)).map((value) => sign * value);
  const best = Math.min(...known);
  if (known.length < 2 || known.every((value) => value === best)) return values.map(() => false);
  return values.map((value) => value !== null && sign * value === best);
}

/** +12.3 %, to three digits at most. */
export function percent(share: number): string {
  const value = 100 * share;
  const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 10 ? 1 : 2;
  const text = Math.abs(value).toFixed(digits);
  return `${Number(text) === 0 ? "±" : value < 0 ? "−" : "+"}${text} %`;
}

/** Values over one axis told over another, by straight lines between the points; outside of them there is nothing. */
export function resampled(x: ArrayLike<number>, y: ArrayLike<number>, at: ArrayLike<number>): Float64Array {
  const found = new Float64Array(at.length).fill(NaN);
  for (let i = 0, next = 1; i < at.length; i++) {
    while (next < x.length - 1 && x[next] < at[i]) next++;
    if (x.length < 2 || at[i] < x[0] || at[i] > x[x.length - 1]) continue;
    const share = (at[i] - x[next - 1]) / (x[next] - x[next - 1]);
    // A value of its own is told as it is, even beside one that is none.
    found[i] = share === 0 ? y[next - 1] : share === 1 ? y[next] : y[next - 1] + share * (y[next] - y[next - 1]);
  }
  return found;
}
