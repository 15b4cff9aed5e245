// Arrow keys turn a value like a knob: 1 % a press, 10 % with Shift, 0.1 % with Alt.

import type { KeyboardEvent } from "react";

/** The factor that a key press stands for; null for other keys. */
export function keyFactor(event: Pick<KeyboardEvent, "key" | "shiftKey" | "altKey" | "ctrlKey" | "metaKey">): number | null {
  if (event.ctrlKey || event.metaKey) return null;
  const step = 1 + (event.shiftKey ? 0.1 : event.altKey ? 0.001 : 0.01);
  if (event.key === "ArrowUp") return step;
  return event.key === "ArrowDown" ? 1 / step : null;
}

export const KNOB_HELP = "↑ ↓ change it by 1 %, with Shift by 10 %, with Alt by 0.1 %";
