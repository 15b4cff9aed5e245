// The work outlives a reload, and goes from one browser to another by a link.

import { session } from "../protocol/client";
import type { Design } from "../protocol/messages";
import { loadDesign } from "./actions";
import { begun } from "./history";
import { packed, unpacked } from "./link";
import { type State, type Theme, current, designOf, isUnsaved, subscribe, update } from "./store";
import { MOST_VARIANTS } from "./variants";
import { type Work, soundWork } from "./work";

const WORK = "torsional.work";
const THEME = "torsional.theme";
const UNSAVED = "torsional.unsaved";

export function workOf(state: State): Work {
  const { name, point, view, settings, selected, variants } = state;
  return { name, design: designOf(state), point, view, settings, selected, variants };
}

export async function linkOf(state: State): Promise<string> {
  return `${location.origin}${location.pathname}#d=${await packed(workOf(state))}`;
}

const SHOWN = "torsional.link";

/** Puts a link into the address bar, where it may be copied from. */
export function showLink(link: string): void {
  history.replaceState(null, "", link);
  sessionStorage.setItem(SHOWN, new URL(link).hash);
}

/** Whether the address is a link that this tab put there itself: a reload then keeps the work that followed. */
export function isOwnLink(hash: string): boolean {
  return hash !== "" && sessionStorage.getItem(SHOWN) === hash;
}

/** Takes work from a link or from the tab's memory; throws for what is none. */
export function takeWork(value: unknown): void {
  const { design, variants, ...rest } = soundWork(value);
  const { text, files, changes } = design;
  setAside();
  const empty = { model: null, faults: [], told: {}, refused: {}, variantsTold: {}, part: "", parts: {} };
  update({ ...empty, ...rest, text, files, history: begun(changes), savedChanges: {}, variants: variants.slice(0, MOST_VARIANTS) });
}

/** Keeps work that was not saved when another design takes its place, so that it can be brought back. */
function setAside(): void {
  const state = current();
  if (state.text) update({ aside: isUnsaved(state) ? workOf(state) : null });
}

/** Another design in place of the present one, which can be brought back if it was not saved. */
export function openDesign(design: Design, name: string): void {
  setAside();
  loadDesign(design, name);
}

export async function takeLink(text: string): Promise<void> {
  takeWork(await unpacked(text));
}

/** The work that this tab had before it was loaded anew; false where there is none. */
export function takeKept(): boolean {
  try {
    const kept = sessionStorage.getItem(WORK);
    if (kept === null) return false;
    takeWork(JSON.parse(kept));
    return true;
  } catch {
    return false;
  }
}

export interface Unsaved {
  time: string;
  session: string;
  work: Work;
}

function stored(): Unsaved | null {
  try {
    return JSON.parse(localStorage.getItem(UNSAVED) ?? "null") as Unsaved | null;
  } catch {
    return null;
  }
}

/** Work with changes that was left unsaved in a tab that is gone; looked for before this tab's work takes its place. */
const left = typeof localStorage === "undefined" ? null : stored();

export function unsavedWork(): Unsaved | null {
  return left !== null && left.session !== session() ? left : null;
}

function keep(): void {
  const state = current();
  if (!state.text) return;
  const work = workOf(state);
  try {
    sessionStorage.setItem(WORK, JSON.stringify(work));
    if (isUnsaved(state)) localStorage.setItem(UNSAVED, JSON.stringify({ time: new Date().toISOString(), session: session(), work }));
    else if (stored()?.session === session()) localStorage.removeItem(UNSAVED);
  } catch {
    // A full or forbidden store keeps nobody from working; a link or a saved file holds the work all the same.
  }
}

export function keepWork(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(keep, 300);
  };
  window.addEventListener("pagehide", keep);
  const quiet = subscribe(soon);
  return () => {
    quiet();
    window.removeEventListener("pagehide", keep);
  };
}

export function keptTheme(): Theme {
  const kept = localStorage.getItem(THEME);
  return kept === "light" || kept === "dark" ? kept : "system";
}

export function keepTheme(theme: Theme): void {
  localStorage.setItem(THEME, theme);
  document.documentElement.dataset.theme = theme;
}
