// The browser of finished sweeps and searches: designs by two of their figures, and what each of them is made of.

import { useMemo, useRef, useState } from "react";
import { Picture } from "../../charts/picture";
import { useLook } from "../../charts/style";
import type { ModelAnswer, Settings, Units } from "../../protocol/messages";
import { useStore } from "../../state/store";
import { amount, axisLabel, shown, told } from "../../units";
import { Choose } from "../settings";
import { scaled } from "../values";
import type { Shown as ShownView, View } from "../view";
import { Chosen } from "./chosen";
import { type Dimension, type Front, axesOf, dimensionsOf, isOnFront, isWithin } from "./designs";
import { useFront } from "./loading";
import { saved } from "./saving";
import { type Reach, Scatter, type Shown } from "./scatter";

function ParetoView({ model, settings, set }: ShownView) {
  const fronts = useStore((state) => state.start?.fronts ?? []);
  const index = Math.min(Math.max(Number(settings.front ?? 0) || 0, 0), Math.max(fronts.length - 1, 0));
  if (!fronts.length) return <Nothing />;
  return (
    <>
      {fronts.length > 1 && (
        <div className="settings">
          <Choose label="Study" options={fronts.map(({ name }, i) => [String(i), name])} value={String(index)} put={(at) => set({ front: Number(at), chosen: null })} />
        </div>
      )}
      <OneFront key={index} index={index} model={model} settings={settings} set={set} />
    </>
  );
}

function Nothing() {
  return (
    <div className="note">
      <p>No finished study was given to the workbench. A search for the best designs, for one:</p>
      <pre>torsional optimise PLAN.yaml -o best.nc{"\n"}torsional workbench MODEL.yaml --results best.nc</pre>
    </div>
  );
}

interface FrontProps {
  index: number;
  model: ModelAnswer;
  settings: Settings;
  set: (settings: Settings) => void;
}

function OneFront({ index, ...rest }: FrontProps) {
  const { front, problem } = useFront(index);
  if (problem) return <p className="banner bad" role="alert">{problem}</p>;
  if (!front) return <p className="note" role="status">Fetching the designs …</p>;
  return <Browser front={front} {...rest} />;
}

/** The quantity of a parameter, by the model's field at its path. */
export function quantityOf(model: ModelAnswer, path: string): string | null {
  for (const group of model.groups) for (const field of group.fields) if (field.path === path) return field.quantity;
  return null;
}

function inUnits(dimension: Dimension, units: Units): Shown {
  const { quantity, label, values, limits } = dimension;
  if (quantity === null) return { ...dimension, axis: label };
  return { ...dimension, values: scaled(values, units, quantity), limits: limits.map((limit) => shown(units, quantity, limit)), axis: axisLabel(units, quantity, label) };
}

function Browser({ front, model, settings, set }: Omit<FrontProps, "index"> & { front: Front }) {
  const units = useStore((state) => state.start?.units ?? {});
  const picture = useRef<HTMLDivElement>(null);
  const [hovered, hover] = useState<number | null>(null);
  const groups = model.groups;
  const dimensions = useMemo(() => dimensionsOf(front, (path) => quantityOf(model, path)), [front, groups]);
  const [x, y] = useMemo(() => axesOf(front, dimensions, settings.x, settings.y).map((dimension) => inUnits(dimension, units)), [front, dimensions, settings.x, settings.y, units]);
  const at = Number(settings.chosen ?? -1);
  const chosen = Number.isInteger(at) && at >= 0 && at < front.designs ? at : null;
  const options = dimensions.map(({ key, label }): [string, string] => [key, label]);
  const hasFront = front.on_front?.data.some((value) => value === 1) ?? false;
  const reach = REACHES.find(([name]) => name === settings.reach)?.[0] ?? (hasFront ? "front" : "within");
  const title = `${front.name}: ${y.label} over ${x.label}`;
  return (
    <>
      <div className="settings" role="group" aria-label="Settings of the front">
        <Choose label="Across" options={options} value={x.key} put={(key) => set({ x: key })} />
        <Choose label="Up" options={options} value={y.key} put={(key) => set({ y: key })} />
        <Choose label="Axes reach to" options={REACHES.filter(([name]) => name !== "front" || hasFront)} value={reach} put={(name) => set({ reach: name })} />
      </div>
      <Picture title={title} note={counted(front)} save={(format) => saved(front, title, picture.current, format)} figures={() => figuresOf(front, x, y)}>
        <div ref={picture}>
          <Scatter front={front} x={x} y={y} reach={reach} chosen={chosen} hovered={hovered} hover={hover} choose={(index) => set({ chosen: index })} />
        </div>
        <output className="readout front">{hovered === null ? "Point at a design, or walk along the front by arrow keys; a click tells all of it." : readingText(front, hovered, units)}</output>
        <FrontKey front={front} hasFront={x.sense !== 0 && y.sense !== 0} hasLimits={x.limits.length + y.limits.length > 0} />
      </Picture>
      {chosen !== null && <Chosen front={front} index={chosen} model={model} />}
    </>
  );
}

const REACHES: [Reach, string][] = [
  ["front", "the front"],
  ["within", "designs within limits"],
  ["all", "all designs"],
];

function counted(front: Front): string {
  const of = front.all > front.designs ? ` of ${front.all}` : "";
  return `${front.designs}${of} designs`;
}

function readingText(front: Front, index: number, units: Units): string {
  const role = front.role?.[index] ? `${front.role[index].replaceAll("_", " ")}: ` : "";
  const figures = front.criteria.map(({ label, quantity, values }) => `${label} ${amount(units, quantity, values.data[index])}`);
  return `${role}${figures.join(", ")}${isWithin(front, index) ? "" : "; beyond limits"}`;
}

function FrontKey({ front, hasFront, hasLimits }: { front: Front; hasFront: boolean; hasLimits: boolean }) {
  const look = useLook();
  const best = { color: look.colours[1] };
  return (
    <p className="key">
      <span><i style={{ color: look.colours[0] }}>●</i> within limits</span>
      {front.within?.data.some((value) => value !== 1) && <span><i style={{ color: look.faint }}>×</i> beyond limits</span>}
      {front.on_front?.data.some((value) => value === 1) && <span><i style={best}>◆</i> on the front of the search</span>}
      {hasFront && <span><i style={best}>⌐</i> bettered by none in these two figures</span>}
      {hasLimits && <span><i style={{ color: look.colours[3] }}>┄</i> limit</span>}
    </p>
  );
}

const MOST_ROWS = 500;

/** The front first, then the rest, as far as a table is of any use. */
function figuresOf(front: Front, x: Shown, y: Shown) {
  const indices = [...x.values.keys()].sort((a, b) => Number(isOnFront(front, b)) - Number(isOnFront(front, a)));
  const words = (index: number) => [isOnFront(front, index) ? "on the front" : "", isWithin(front, index) ? "" : "beyond limits", front.role?.[index] ?? ""].filter(Boolean).join(", ");
  return {
    columns: ["design", x.axis, y.axis, "what it is"],
    rows: indices.slice(0, MOST_ROWS).map((index) => [index + 1, told(x.values[index]), told(y.values[index]), words(index)]),
  };
}

export const PARETO: View = { name: "pareto", title: "Pareto front", asks: () => [], compares: false, component: ParetoView };
