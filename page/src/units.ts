// Numbers between SI and what is shown and typed, by the table of units that the server sends.

import type { Units } from "./protocol/messages";

export function shown(units: Units, quantity: string, value: number): number {
  return value / (units[quantity]?.factor ?? 1);
}

export function si(units: Units, quantity: string, value: number): number {
  return value * (units[quantity]?.factor ?? 1);
}

export function unitOf(units: Units, quantity: string): string {
  const unit = units[quantity]?.unit ?? "";
  return unit === "-" ? "" : unit;
}

/** The name of a quantity with its unit: acceleration [rad/s²]. */
export function axisLabel(units: Units, quantity: string, label = ""): string {
  const unit = unitOf(units, quantity);
  return `${label || units[quantity]?.label || quantity}${unit ? ` [${unit}]` : ""}`;
}

/** A number to so many significant digits, without an exponent where none is needed. */
export function told(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  return size !== 0 && (size >= 1e7 || size < 1e-4) ? rounded.toExponential() : String(rounded);
}

/** A value in the unit in which its quantity is shown: 412.3 rpm. */
export function amount(units: Units, quantity: string, value: number, digits = 4): string {
  const unit = unitOf(units, quantity);
  return told(shown(units, quantity, value), digits) + (unit ? ` ${unit}` : "");
}

const NUMBER = /^(\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)([\s\S]*)$/;

/** A typed value with its number multiplied, the unit as it was: 25 kNm/rad and 1.01 is 25.25 kNm/rad; null if it has none. */
export function scaledText(text: string, factor: number): string | null {
  const matched = NUMBER.exec(text);
  if (matched === null) return null;
  return told(Number(matched[1]) * factor, 6) + matched[2];
}

/** A typed value one step up or down: zero, which has no per cents, goes up by a hundredth of its unit. */
export function steppedText(text: string, factor: number): string | null {
  const matched = NUMBER.exec(text);
  if (matched === null || Number(matched[1]) !== 0) return scaledText(text, factor);
  return factor > 1 ? `0.01${matched[2]}` : null;
}

/** A count one step up or down, by ten where the step is a large one; null for a text that is no whole number. */
export function countedText(text: string, factor: number): string | null {
  if (!/^\s*[+-]?\d+\s*$/.test(text)) return null;
  const step = Math.abs(Math.log(factor)) > 0.05 ? 10 : 1;
  return String(Number(text) + (factor > 1 ? step : -step));
}
