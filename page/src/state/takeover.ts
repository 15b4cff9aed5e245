// Values of a design of a finished study, made changes of the present one.

import type { Changes, Json, Unit } from "../protocol/messages";
import { begun, changed } from "./history";

export interface Value {
  path: string;
  /** In SI where it is a number. */
  value: number | string;
  /** How values of its quantity are shown, where that is known. */
  unit: Unit | undefined;
}

/** A value as it would be typed, if that is read as the very same number; else the number in SI. */
export function typed({ value, unit }: Value): Json {
  if (typeof value === "string" || !unit || !unit.unit || unit.unit === "-") return value;
  const shown = value / unit.factor;
  const near = [shown, Number(shown.toPrecision(15)), Number(shown.toPrecision(16)), shown * (1 + Number.EPSILON), shown * (1 - Number.EPSILON)];
  const exact = near.find((number) => number * unit.factor === value);
  return exact === undefined ? value : `${exact} ${unit.unit}`;
}

/** Changes with values of another design in them, each in the place of what it replaces. */
export function withValues(changes: Changes, values: Value[]): Changes {
  return values.reduce((history, value) => changed(history, value.path, typed(value)), begun(changes)).present;
}
