// A front as a file: its designs as a table in SI, or the picture as it stands.

import { pngOf, svgOf } from "../../charts/snapshot";
import { currentLook } from "../../charts/style";
import type { Download, Format } from "../../protocol/client";
import { type Front, isOnFront, isWithin } from "./designs";

/** A cell that no spreadsheet takes for a formula, and that holds commas and quotes. */
export function cell(value: string | number): string {
  if (typeof value === "number") return Number.isFinite(value) ? String(value) : "";
  const harmless = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
  return /[",\n\r]/.test(harmless) ? `"${harmless.replaceAll('"', '""')}"` : harmless;
}

/** Every design with its values and figures; numbers are in SI, as results files have them. */
export function csvOf(front: Front): string {
  const columns: [string, (index: number) => string | number][] = [
    ["design", (index) => index + 1],
    ...front.parameters.map(({ path, values }): (typeof columns)[number] => [path, (index) => (Array.isArray(values) ? values[index] : values.data[index])]),
    ...front.criteria.map(({ name, values }): (typeof columns)[number] => [name, (index) => values.data[index]]),
    ["on_front", (index) => Number(isOnFront(front, index))],
    ["within", (index) => Number(isWithin(front, index))],
    ["role", (index) => front.role?.[index] ?? ""],
  ];
  const rows = Array.from({ length: front.designs }, (_, index) => columns.map(([, value]) => cell(value(index))).join(","));
  return `\ufeff${[columns.map(([name]) => cell(name)).join(","), ...rows].join("\r\n")}\r\n`;
}

export async function saved(front: Front, title: string, picture: Element | null, format: Format): Promise<Download> {
  const name = `${front.name}.${format}`;
  if (format === "csv") return { name, blob: new Blob([csvOf(front)], { type: "text/csv" }) };
  const svg = svgOf(picture, currentLook());
  if (svg === null) throw new Error(`there is no picture of ${title} on the page: leave its figures first`);
  return { name, blob: format === "svg" ? new Blob([svg], { type: "image/svg+xml" }) : await pngOf(svg) };
}
