// From values to places on the paper, and round values for the axes.

export type Range = [number, number];

/** The least and the largest number of several rows; what is no number is passed over. */
export function extent(...rows: ArrayLike<number>[]): Range {
  let low = Infinity;
  let high = -Infinity;
  for (const row of rows) {
    for (let i = 0; i < row.length; i++) {
      if (row[i] < low) low = row[i];
      if (row[i] > high) high = row[i];
    }
  }
  return low <= high && Number.isFinite(high - low) ? [low, high] : [0, 1];
}

/** A range with room at both ends; one value alone gets a range around it. */
export function padded([low, high]: Range, share = 0.05): Range {
  const room = high > low ? (high - low) * share : Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

export interface Scale {
  place: (value: number) => number;
  value: (place: number) => number;
}

export function linear([low, high]: Range, [from, to]: Range): Scale {
  const slope = (to - from) / (high - low || 1);
  return { place: (value) => from + (value - low) * slope, value: (place) => low + (place - from) / slope };
}

/** Round values in a range, about as many as asked for. */
export function ticks([low, high]: Range, count: number): number[] {
  const raw = (high - low) / Math.max(count, 1);
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999)! * power;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/** 1, 2 and 5 of every decade in a range. */
export function logTicks([low, high]: Range): number[] {
  const decades = Array.from({ length: 24 }, (_, i) => i - 10);
  const values = decades.flatMap((decade) => [1, 2, 5].map((factor) => Number((factor * 10 ** decade).toPrecision(3))));
  return values.filter((value) => value >= low * 0.999 && value <= high * 1.001);
}

/** The index of the value next to one, of rising values. */
export function nearest(values: ArrayLike<number>, value: number): number {
  let best = 0;
  for (let i = 1; i < values.length; i++) {
    if (Math.abs(values[i] - value) < Math.abs(values[best] - value)) best = i;
  }
  return best;
}
