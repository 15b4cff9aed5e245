// What a run in time tells: channels grouped into panels, values at an instant, and settings read from lines of text.

import type { Grid, Json, Settings } from "../../protocol/messages";
import type { Moved } from "./windup";

export interface Channel {
  /** What it is and where, as in torque:dmf. */
  name: string;
  label: string;
  quantity: string | null;
  values: Grid;
}

export interface Run {
  title: string;
  gear: string;
  status: string;
  time: Grid;
  channels: Channel[];
  moved?: Moved;
  events: { time: number; text: string }[];
  /** The twists [rad] at which a connection meets its stops. */
  stops: { [connection: string]: [number, number] };
  measures: { name: string; label: string; quantity: string | null; value: number; text: string }[];
  notes: string[];
}

export interface PanelOf {
  kind: string;
  title: string;
  quantity: string | null;
  channels: Channel[];
}

const TITLES: { [kind: string]: string } = { angular_velocity: "Speeds", twist: "Twists", slip: "Slip", torque: "Torques", done: "What is done" };

/** A channel's kind and place. */
export function parts(channel: Channel): [kind: string, place: string] {
  const at = channel.name.indexOf(":");
  return [channel.name.slice(0, at), channel.name.slice(at + 1)];
}

const TURN = 2 * Math.PI;

/** Whether a connection turns through, as an open clutch does: beside it the twists of springs would be nothing. */
export function slips(channel: Channel): boolean {
  return parts(channel)[0] === "twist" && channel.values.data.some((twist) => Math.abs(twist) > TURN);
}

/** Channels of one kind and quantity share a panel, in the order of their first appearance. */
export function panelsOf(run: Run): PanelOf[] {
  const panels = new Map<string, PanelOf>();
  for (const channel of run.channels) {
    const kind = slips(channel) ? "slip" : parts(channel)[0];
    const key = `${kind} ${channel.quantity}`;
    const panel = panels.get(key) ?? { kind, title: TITLES[kind] ?? kind, quantity: channel.quantity, channels: [] };
    panel.channels.push(channel);
    panels.set(key, panel);
  }
  return [...panels.values()];
}

/** A value between the instants that were kept. */
export function valueAt(time: Float64Array, values: Float64Array, at: number): number {
  let [low, high] = [0, time.length - 1];
  if (high < 0) return NaN;
  if (at <= time[0]) return values[0];
  if (at >= time[high]) return values[high];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (time[middle] <= at) low = middle;
    else high = middle;
  }
  return values[low] + ((at - time[low]) / (time[high] - time[low])) * (values[high] - values[low]);
}

/** Lines of "key: value" as the keys of a scenario's file; throws for a line that is none. */
export function valuesOf(text: string): Settings {
  const lines = text.split("\n").map((line) => line.trim()).filter((line) => line && !line.startsWith("#"));
  return Object.fromEntries(lines.map(pair));
}

function pair(line: string): [string, Json] {
  const at = line.indexOf(":");
  if (at < 1 || !line.slice(at + 1).trim()) throw new Error(`"${line}" is no line of the form key: value`);
  const value = line.slice(at + 1).trim();
  return [line.slice(0, at).trim(), plain(value)];
}

/** Numbers, yes and no, and lists of them as YAML reads them; all else is text. */
function plain(value: string): Json {
  if (value === "true" || value === "false") return value === "true";
  if (value.startsWith("[") && value.endsWith("]")) return value.slice(1, -1).split(",").map((item) => plain(item.trim()));
  return value !== "" && Number.isFinite(Number(value)) ? Number(value) : value;
}

/** Evenly chosen rows of a long table, its last one among them. */
export function chosenRows(count: number, most: number): number[] {
  if (count <= most) return Array.from({ length: count }, (_, i) => i);
  return Array.from({ length: most }, (_, i) => Math.round((i * (count - 1)) / (most - 1)));
}
