// The changes to a design, with every step undoable; a run of key presses in one field is one step.

import type { Changes, Json } from "../protocol/messages";

export interface History {
  past: Changes[];
  present: Changes;
  future: Changes[];
  /** The field whose run of edits the last step belongs to; null after a run has ended. */
  run: string | null;
}

const LONGEST = 500;

export function begun(changes: Changes = {}): History {
  return { past: [], present: changes, future: [], run: null };
}

/** A value set; undefined gives back what the file says. Values below a path that is set as a whole are dropped. */
export function changed(history: History, path: string, value: Json | undefined): History {
  const kept = Object.entries(history.present).filter(([key]) => key !== path && !key.startsWith(`${path}.`));
  const present = Object.fromEntries(value === undefined ? kept : [...kept, [path, value]]);
  if (JSON.stringify(present) === JSON.stringify(history.present)) return history;
  return stepped(history, present, path);
}

/** All changes at once, as one step. */
export function replaced(history: History, changes: Changes): History {
  return stepped(history, changes, null);
}

function stepped(history: History, present: Changes, run: string | null): History {
  const goesOn = run !== null && history.run === run;
  const past = goesOn ? history.past : [...history.past, history.present].slice(-LONGEST);
  return { past, present, future: [], run };
}

export function runEnded(history: History): History {
  return history.run === null ? history : { ...history, run: null };
}

export function undone(history: History): History {
  const last = history.past.at(-1);
  if (last === undefined) return history;
  return { past: history.past.slice(0, -1), present: last, future: [history.present, ...history.future], run: null };
}

export function redone(history: History): History {
  const [next, ...future] = history.future;
  if (next === undefined) return history;
  return { past: [...history.past, history.present], present: next, future, run: null };
}
