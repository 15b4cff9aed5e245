// Designs kept beside the present one, to be compared with it and taken back.

import type { Variant } from "../protocol/client";
import type { Changes, Design, Json } from "../protocol/messages";
import { loadDesign, setChanges, tell } from "./actions";
import { type State, current, designOf, update } from "./store";

/** With the present design four, as many as a report or an exported picture takes. */
export const MOST_VARIANTS = 3;

/** A name that no other variant has. */
export function freeName(wanted: string, taken: string[]): string {
  const name = wanted.trim() || "variant";
  if (!taken.includes(name)) return name;
  for (let n = 2; ; n++) if (!taken.includes(`${name} ${n}`)) return `${name} ${n}`;
}

/** What a design may be called: the last of its changes, in a few words. */
export function gist(changes: Changes): string {
  const last = Object.entries(changes).at(-1);
  if (last === undefined) return "as loaded";
  const [path, value] = last;
  const key = path.split(".").at(-1)!.replaceAll("_", " ");
  const told = value === null ? "removed" : typeof value === "object" ? String((value as { type?: Json }).type ?? "").replaceAll("_", " ") : String(value);
  return `${key} ${told}${Object.keys(changes).length > 1 ? " …" : ""}`.slice(0, 60);
}

/** Keeps a design, by default the present one; false, and said so, where there is no room left. */
export function keepVariant(name: string, design: Design = designOf(current())): boolean {
  const { variants } = current();
  if (variants.length >= MOST_VARIANTS) {
    tell(`${MOST_VARIANTS + 1} designs are compared at most: remove a variant first.`);
    return false;
  }
  const taken = variants.map((variant) => variant.name);
  update({ variants: [...variants, { name: freeName(name, taken), design }] });
  return true;
}

/** Variants and what was told of them, in a new order; places that are left out are gone. */
function arranged(state: State, order: number[]): Partial<State> {
  const rows = Object.entries(state.variantsTold).map(([view, row]) => [view, order.map((index) => row[index])]);
  return { variants: order.map((index) => state.variants[index]), variantsTold: Object.fromEntries(rows) };
}

function places(state: State): number[] {
  return state.variants.map((_, index) => index);
}

export function dropVariant(index: number): void {
  update((state) => arranged(state, places(state).filter((other) => other !== index)));
}

/** Exchanges a variant with the one before it. */
export function moveVariantUp(index: number): void {
  if (index < 1) return;
  update((state) => arranged(state, places(state).map((place) => (place === index ? index - 1 : place === index - 1 ? index : place))));
}

export function renameVariant(index: number, name: string): void {
  update((state) => ({ variants: state.variants.map((variant, i) => (i === index ? { ...variant, name } : variant)) }));
}

/** Makes a variant the present design: a step that can be undone, or, of another file, an exchange that loses nothing. */
export function takeBack(index: number): void {
  const state = current();
  const { name, design } = state.variants[index];
  if (isOfFile(design, state)) return setChanges(design.changes);
  const present: Variant = { name: state.name, design: designOf(state) };
  const variants = state.variants.map((variant, i) => (i === index ? present : variant));
  loadDesign(design, /\.(ya?ml|json)$/i.test(name) ? name : `${name}.yaml`);
  update({ variants, variantsTold: {} });
  tell(`${name} is the present design; ${present.name} is kept in its place.`);
}

function isOfFile(design: Design, file: Pick<Design, "text" | "files">): boolean {
  return design.text === file.text && JSON.stringify(design.files) === JSON.stringify(file.files);
}

/** A key path whose value is not the same in all designs; undefined is what the file says. */
export interface Difference {
  path: string;
  values: (Json | undefined)[];
}

/** What differs between designs; null where they are of different files. */
export function differences(designs: Design[]): Difference[] | null {
  if (designs.some((design) => !isOfFile(design, designs[0]))) return null;
  const paths = [...new Set(designs.flatMap(({ changes }) => Object.keys(changes)))].sort();
  return paths
    .map((path) => ({ path, values: designs.map(({ changes }) => changes[path]) }))
    .filter(({ values }) => new Set(values.map((value) => JSON.stringify(value))).size > 1);
}
