import type { Units } from "../protocol/messages";

/** Values of a quantity in the unit in which it is shown. */
export function scaled(values: Float64Array, units: Units, quantity: string): Float64Array {
  const factor = units[quantity]?.factor ?? 1;
  return factor === 1 ? values : values.map((value) => value / factor);
}

/** A component's name as words: gearbox_input is gearbox input. */
export function words(name: string): string {
  return name.replaceAll("_", " ");
}
