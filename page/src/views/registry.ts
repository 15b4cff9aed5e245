// The views of the page in the order of their tabs; a new one is a module of its own and a line here.

import { BRANCHES } from "./branches/view";
import { CHARACTERISTIC } from "./characteristic";
import { COMPARISON } from "./comparison/view";
import { INTERFERENCE } from "./interference";
import { MAP } from "./map";
import { MODES } from "./modes";
import { PARETO } from "./pareto/view";
import { RESPONSE } from "./response";
import { SCENARIOS } from "./scenario/view";
import type { View } from "./view";

export const VIEWS: View[] = [MODES, INTERFERENCE, RESPONSE, MAP, CHARACTERISTIC, BRANCHES, SCENARIOS, COMPARISON, PARETO];

/** A view by its name; the first one for a name of an older link. */
export function viewNamed(name: string): View {
  return VIEWS.find((view) => view.name === name) ?? VIEWS[0];
}
