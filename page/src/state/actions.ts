// What the user can do to the design, each in one place for buttons, keys and menus alike.

import type { Changes, Design, Json, Settings } from "../protocol/messages";
import { begun, changed, redone, replaced, runEnded, undone } from "./history";
import { type Point, update } from "./store";

export function setValue(path: string, value: Json | undefined): void {
  update((state) => ({ history: changed(state.history, path, value) }));
}

/** A value picked rather than typed: a step of its own. */
export function chooseValue(path: string, value: Json | undefined): void {
  endRun();
  setValue(path, value);
  endRun();
}

export function setChanges(changes: Changes): void {
  update((state) => ({ history: replaced(state.history, changes) }));
}

export function endRun(): void {
  update((state) => ({ history: runEnded(state.history) }));
}

export function undo(): void {
  update((state) => ({ history: undone(state.history) }));
}

export function redo(): void {
  update((state) => ({ history: redone(state.history) }));
}

/** Another design in place of the present one; its past is its own. */
export function loadDesign(design: Design, name: string): void {
  const { text, files, changes } = design;
  const empty = { model: null, faults: [], told: {}, refused: {}, variantsTold: {}, selected: "", part: "", parts: {} };
  update({ ...empty, text, files, name, history: begun(changes), savedChanges: changes, notice: "" });
  setPoint({ gear: null, torque: null, speed: null });
}

export function setPoint(point: Partial<Point>): void {
  update((state) => ({ point: { ...state.point, ...point } }));
}

/** The values of a block, or of one part of the drawing that comes from it. */
export function select(path: string, part = ""): void {
  endRun();
  update({ selected: path, part });
}

export function setView(view: string): void {
  update({ view });
}

export function setSettings(view: string, settings: Settings): void {
  update((state) => ({ settings: { ...state.settings, [view]: { ...state.settings[view], ...settings } } }));
}

export function tell(notice: string): void {
  update({ notice });
}
