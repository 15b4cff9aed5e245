// What the page knows; parts of it subscribe to the values that they show.

import { useSyncExternalStore } from "react";
import type { JobKind, Variant } from "../protocol/client";
import type { Ask, Changes, Design, Fault, ModelAnswer, Settings, Start } from "../protocol/messages";
import { type History, begun } from "./history";
import type { Job } from "./jobs";
import type { Incomplete } from "./opening";
import type { Work } from "./work";

export type Theme = "system" | "light" | "dark";

/** The operating point; null is the model's own choice. */
export interface Point {
  gear: string | null;
  torque: number | null;
  speed: number | null;
}

/** What a view was last told: the answers to its asks, and for which design. */
export interface Told {
  asks: Ask[];
  answers: object[];
}

export interface State {
  start: Start | null;
  name: string;
  text: string;
  files: Record<string, string>;
  /** The changes that the last saved file holds. */
  savedChanges: Changes;
  history: History;
  point: Point;
  view: string;
  settings: { [view: string]: Settings };
  /** Key path of the block whose values are shown. */
  selected: string;
  /** The disc or link that was chosen in the drawing; empty where none was. */
  part: string;
  /** Key paths of the values that each disc and link is made of, once the server has told. */
  parts: { [part: string]: string[] };
  theme: Theme;
  variants: Variant[];
  connection: "good" | "lost" | "busy";
  /** What keeps the page from starting at all. */
  stopped: string;
  notice: string;
  incomplete: Incomplete | null;
  /** Work that was not saved when another design took its place. */
  aside: Work | null;
  model: ModelAnswer | null;
  faults: Fault[];
  told: { [view: string]: Told };
  refused: { [view: string]: Fault[] };
  variantsTold: { [view: string]: (Told | undefined)[] };
  /** What is worked on in the background, or was last: one of each kind. */
  jobs: { [kind in JobKind]?: Job };
}

const EMPTY: State = {
  start: null,
  name: "",
  text: "",
  files: {},
  savedChanges: {},
  history: begun(),
  point: { gear: null, torque: null, speed: null },
  view: "response",
  settings: {},
  selected: "",
  part: "",
  parts: {},
  theme: "system",
  variants: [],
  connection: "good",
  stopped: "",
  notice: "",
  incomplete: null,
  aside: null,
  model: null,
  faults: [],
  told: {},
  refused: {},
  variantsTold: {},
  jobs: {},
};

let state = EMPTY;
const listeners = new Set<() => void>();

export function current(): State {
  return state;
}

export function update(change: Partial<State> | ((state: State) => Partial<State>)): void {
  state = { ...state, ...(typeof change === "function" ? change(state) : change) };
  for (const listener of listeners) listener();
}

export function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** A value of the state; whoever asks is drawn anew when it is another one. */
export function useStore<T>(select: (state: State) => T): T {
  return useSyncExternalStore(subscribe, () => select(state));
}

export function designOf(state: State): Design {
  return { text: state.text, files: state.files, changes: state.history.present };
}

export function isUnsaved(state: State): boolean {
  return JSON.stringify(state.history.present) !== JSON.stringify(state.savedChanges);
}
