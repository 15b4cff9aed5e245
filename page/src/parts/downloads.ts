// Files that the page hands to the user, and what is told when that fails.

import type { Download } from "../protocol/client";
import { tell } from "../state/actions";

export function handOver({ blob, name }: Download): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // Some browsers read the file after the click has returned.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

/** Does what a button promises, and says so when it cannot. */
export async function attempt(what: string, doing: () => Promise<unknown>): Promise<void> {
  try {
    await doing();
  } catch (problem) {
    tell(`${what}: ${problem instanceof Error ? problem.message : String(problem)}`);
  }
}
