// The views of the page in the order of their tabs; a new one is a module of its own and a line here.

import { RESPONSE } from "./response";
import type { View } from "./view";

export const VIEWS: View[] = [RESPONSE];

/** A view by its name; the first one for a name of an older link. */
export function viewNamed(name: string): View {
  return VIEWS.find((view) => view.name === name) ?? VIEWS[0];
}
