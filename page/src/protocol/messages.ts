// What page and server tell one another; numbers are in SI units and radians.

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Settings = { [name: string]: Json };

/** What was changed since the file was loaded: key path → what the user typed, null for a key taken out. */
export type Changes = { [path: string]: Json };

export interface Design {
  text: string;
  files: { [name: string]: string };
  changes: Changes;
}

export interface Ask extends Settings {
  view: string;
}

/** One thing that is wrong, told so that it can be mended. */
export interface Fault {
  where: string;
  problem: string;
  found: string;
  allowed: string;
  remedy: string;
  text: string;
}

/** An array of a frame: its values row by row, and its shape. */
export interface Grid {
  data: Float64Array;
  shape: number[];
}

export type Answer<T> = T | { errors: Fault[] };

export function isRefused<T extends object>(answer: Answer<T>): answer is { errors: Fault[] } {
  return "errors" in answer;
}

export interface Unit {
  unit: string;
  factor: number;
  label: string;
  symbol?: string;
}

export type Units = { [quantity: string]: Unit };

export interface Absorber {
  name?: string;
  type?: string;
  label: string;
  block: Json;
}

export interface Named {
  name: string;
  title?: string;
}

export interface Start {
  version: string;
  design: Design;
  name: string;
  units: Units;
  fronts: Named[];
  scenarios: Named[];
  absorbers: Absorber[];
  limits: { body: number };
  examples: Named[];
}

export interface Field {
  path: string;
  label: string;
  /** What of a block the value belongs to, as a stage of its springs; empty for the block itself. */
  section: string;
  kind: "quantity" | "number" | "choice" | "text" | "switch" | "list";
  quantity: string | null;
  text: string;
  value: number | null;
  given: boolean;
  unit: string;
  least: number | null;
  above: number | null;
  most: number | null;
  below: number | null;
  choices: string[];
  help: string;
}

export interface FieldGroup {
  path: string;
  label: string;
  fields: Field[];
}

export interface ChainNode {
  name: string;
  label: string;
  x: number;
  y: number;
  inertia: number;
  ratio: number;
  path: string;
}

export interface ChainLink {
  name: string;
  label: string;
  kind: string;
  nodes: string[];
  told: string;
  path: string;
}

export interface ModelAnswer {
  name: string;
  gears: string[];
  gear: string;
  ratios: number[];
  operation: { idle: number; speed: [number, number]; torque: [number, number] | null };
  full_load: { speed: Grid; torque: Grid } | null;
  orders: number[];
  main_order: number | null;
  nodes: string[];
  elements: string[];
  landmarks: {
    crankshaft: string;
    input: string;
    load: string;
    clutch: string;
    springs: string[];
    throws: string[];
  };
  absorber: { type: string; label: string } | null;
  groups: FieldGroup[];
  chain: { nodes: ChainNode[]; links: ChainLink[] };
  warnings: string[];
}

export interface JobState {
  state: "waiting" | "running" | "done" | "failed" | "cancelled";
  done: number;
  total: number;
  text: string;
  errors: Fault[];
  place: number | null;
}
