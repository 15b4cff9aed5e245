// What a link and the tab's memory hold, and what of it is believed: a link may come from anybody.

import type { Variant } from "../protocol/client";
import type { Design, Settings } from "../protocol/messages";
import type { Point } from "./store";

export interface Work {
  name: string;
  design: Design;
  point: Point;
  view: string;
  settings: { [view: string]: Settings };
  selected: string;
  variants: Variant[];
}

type Map = { [key: string]: unknown };

function isMap(value: unknown): value is Map {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function isDesign(value: unknown): value is Design {
  if (!isMap(value) || typeof value.text !== "string" || !isMap(value.changes) || !isMap(value.files)) return false;
  return Object.values(value.files).every((text) => typeof text === "string");
}

function isVariant(value: unknown): value is Variant {
  return isMap(value) && typeof value.name === "string" && isDesign(value.design);
}

function soundPoint(value: unknown): Point {
  const { gear, torque, speed } = isMap(value) ? value : ({} as Map);
  const number = (given: unknown) => (typeof given === "number" && Number.isFinite(given) ? given : null);
  return { gear: typeof gear === "string" ? gear : null, torque: number(torque), speed: number(speed) };
}

/** The work that a value holds, anything that is not as it should be left out; throws where there is no design. */
export function soundWork(value: unknown): Work {
  const work = isMap(value) ? value : ({} as Map);
  if (!isDesign(work.design)) throw new TypeError("no design");
  const text = (given: unknown) => (typeof given === "string" ? given : "");
  const settings = isMap(work.settings) ? Object.entries(work.settings).filter(([, each]) => isMap(each)) : [];
  return {
    name: text(work.name),
    design: work.design,
    point: soundPoint(work.point),
    view: text(work.view),
    settings: Object.fromEntries(settings) as Work["settings"],
    selected: text(work.selected),
    variants: Array.isArray(work.variants) ? work.variants.filter(isVariant) : [],
  };
}
