// Limits and faults of a field in words.

import type { Fault, Field } from "../protocol/messages";
import { told } from "../units";

/** What a value may be, as in "above 0 kgm²"; empty where nothing bounds it. */
export function limitsOf(field: Field): string {
  const bounds: [string, number | null][] = [
    ["above", field.above],
    ["at least", field.least],
    ["below", field.below],
    ["at most", field.most],
  ];
  const words = bounds.filter(([, bound]) => bound !== null).map(([word, bound]) => `${word} ${told(bound!)}`);
  return words.length ? `${words.join(", ")}${field.unit ? ` ${field.unit}` : ""}` : "";
}

/** Whether a fault is about the value at a key path, or about something inside it. */
export function isAbout(fault: Fault, path: string): boolean {
  const where = fault.where.replaceAll("[", ".").replaceAll("]", "");
  return where === path || where.startsWith(`${path}.`);
}

/** A fault as the field's own message: what is wrong, what is allowed, what helps. */
export function faultText(fault: Fault): string {
  const parts = [
    fault.problem + (fault.found ? `: found ${fault.found}` : ""),
    fault.allowed && `allowed: ${fault.allowed}`,
    fault.remedy,
  ];
  return parts.filter(Boolean).join("; ") || fault.text;
}
