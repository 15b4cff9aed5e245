// Order response over speed at chosen places, an axis to each place.

import { useMemo } from "react";
import { type Line, Lines } from "../charts/lines";
import { type Figures, Picture } from "../charts/picture";
import { row } from "../protocol/frame";
import type { Ask, Grid, Json, ModelAnswer, Settings, Units } from "../protocol/messages";
import { setPoint } from "../state/actions";
import { type Told, useStore } from "../state/store";
import { amount, axisLabel, shown, si, told as number } from "../units";
import { Choices, Choose } from "./settings";
import { scaled } from "./values";
import type { Context, Shown, View } from "./view";

interface Place {
  name: string;
  label: string;
  kind: "node" | "element";
  quantity: string;
}

interface Response {
  gear: string;
  speed: Grid;
  torque: Grid;
  orders: number[];
  places: Place[];
  value: Grid;
  idle: number;
  range: [number, number];
}

/** Those of some chosen names that the model has; null where none was chosen. */
function known(chosen: Json | undefined, names: string[] | undefined): string[] | null {
  if (!Array.isArray(chosen)) return null;
  return (chosen as string[]).filter((name) => names === undefined || names.includes(name));
}

function asks({ model, point, settings }: Context): Ask[] {
  const ask: Ask = { view: "response" };
  if (point.gear !== null) ask.gear = point.gear;
  if (point.torque !== null) ask.torque = point.torque;
  const nodes = known(settings.nodes, model?.nodes);
  const elements = known(settings.elements, model?.elements);
  if (nodes?.length || elements?.length) Object.assign(ask, { nodes: nodes ?? [], elements: elements ?? [] });
  const orders = settings.orders;
  if (Array.isArray(orders) && orders.length) ask.orders = orders;
  if (settings.quantity) ask.quantity = settings.quantity;
  return [ask];
}

function ResponseView({ told, variants, model, settings, set }: Shown) {
  const found = told.answers[0] as Response;
  const others = variants.map(({ name, told: other }) => ({ name, found: other?.answers[0] as Response | undefined }));
  return (
    <>
      <ResponseSettings found={found} model={model} settings={settings} set={set} />
      <div className="pictures">
        {found.places.map((place, index) => (
          <PlacePicture key={`${place.kind} ${place.name}`} found={found} index={index} others={others} ask={told.asks[0]} log={settings.log === true} />
        ))}
      </div>
    </>
  );
}

interface PlaceProps {
  found: Response;
  index: number;
  others: { name: string; found: Response | undefined }[];
  ask: Ask;
  log: boolean;
}

function PlacePicture({ found, index, others, ask, log }: PlaceProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const at = useStore((state) => state.point.speed);
  const place = found.places[index];
  const speed = useMemo(() => scaled(found.speed.data, units, "speed"), [found, units]);
  const lines = useMemo(() => {
    const line = (from: Response, order: number, variant: string, dash: number): Line | null => {
      const placeIndex = from.places.findIndex((other) => other.name === place.name && other.kind === place.kind);
      const orderIndex = from.orders.indexOf(order);
      if (placeIndex < 0 || orderIndex < 0 || from.speed.data.length !== found.speed.data.length) return null;
      const values = scaled(row(from.value, placeIndex, orderIndex), units, place.quantity);
      return { name: `order ${order}${variant}`, values, colour: found.orders.indexOf(order), dash, width: dash ? 1.4 : 2 };
    };
    const own = found.orders.map((order) => line(found, order, "", 0));
    const compared = others.flatMap(({ name, found: other }, i) =>
      other ? found.orders.map((order) => line(other, order, ` · ${name}`, i + 1)) : [],
    );
    return [...own, ...compared].filter((each) => each !== null);
  }, [found, units, place, ...others.map((other) => other.found)]);
  const shownRange = found.range.map((value) => shown(units, "speed", value)) as [number, number];
  const marks = { idle: shown(units, "speed", found.idle), range: shownRange, at: at === null ? null : shown(units, "speed", at) };
  const figures = (): Figures => ({
    columns: [axisLabel(units, "speed"), ...lines.map((line) => line.name)],
    rows: [...speed].map((value, i) => [number(value), ...lines.map((line) => number(line.values[i]))]),
  });
  const subject = `${axisLabel(units, place.quantity, quantityName(place.quantity))}, 0-peak`;
  const title = `${place.label}: ${quantityName(place.quantity)}`;
  return (
    <Picture title={title} ask={only(ask, place)} compared={others.length > 0} figures={figures}>
      <Lines label={`${title} over speed by order`} x={{ values: speed, label: axisLabel(units, "speed", "speed") }} y={{ label: subject, log }} lines={lines} marks={marks} onPick={(value) => setPoint({ speed: si(units, "speed", Math.round(value)) })} height={250} />
    </Picture>
  );
}

function quantityName(quantity: string): string {
  return quantity.replaceAll("_", " ");
}

/** The ask of one place alone, for its export. */
function only(ask: Ask, place: Place): Ask {
  return { ...ask, nodes: place.kind === "node" ? [place.name] : [], elements: place.kind === "element" ? [place.name] : [] };
}

interface SettingsProps {
  found: Response;
  model: ModelAnswer;
  settings: Settings;
  set: (settings: Settings) => void;
}

function ResponseSettings({ found, model, settings, set }: SettingsProps) {
  const of = (kind: Place["kind"]) => found.places.filter((place) => place.kind === kind).map((place) => place.name);
  const places = (nodes: string[], elements: string[]) => set({ nodes, elements });
  return (
    <div className="settings" role="group" aria-label="Settings of the response">
      <Choices label="Nodes" options={model.nodes} chosen={of("node")} put={(nodes) => places(nodes, of("element"))} />
      <Choices label="Connections" options={model.elements} chosen={of("element")} put={(elements) => places(of("node"), elements)} />
      <Choices label="Orders" options={model.orders.map(String)} chosen={found.orders.map(String)} put={(orders) => set({ orders: orders.map(Number) })} />
      <Choose label="Nodes by" options={[["acceleration", "acceleration"], ["angular_velocity", "angular velocity"], ["angle", "angle"]]} value={String(settings.quantity ?? "acceleration")} put={(quantity) => set({ quantity })} />
      <label className="check">
        <input type="checkbox" checked={settings.log === true} onChange={(event) => set({ log: event.target.checked })} /> logarithmic
      </label>
    </div>
  );
}

/** Of each place the largest amplitude of the first order, and at which speed. */
function summary(told: Told, units: Units): string {
  const found = told.answers[0] as Response;
  const sentences = found.places.map((place, index) => {
    const values = row(found.value, index, 0);
    const at = values.reduce((best, value, i) => (value > values[best] ? i : best), 0);
    return `${place.label}: order ${found.orders[0]} at most ${amount(units, place.quantity, values[at])} at ${amount(units, "speed", found.speed.data[at])}`;
  });
  return sentences.join("; ");
}

export const RESPONSE: View = { name: "response", title: "Response", asks, compares: true, component: ResponseView, summary };
