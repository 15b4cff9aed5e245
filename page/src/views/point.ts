import type { Settings } from "../protocol/messages";
import type { Point } from "../state/store";

/** The operating point as settings of an ask: what was not chosen is left to the server. */
export function pointOf(point: Point): Settings {
  return Object.fromEntries(Object.entries(point).filter(([, value]) => value !== null));
}

/** The gear alone. */
export function gearOf({ gear }: Point): Settings {
  return pointOf({ gear, torque: null, speed: null });
}
