// Torque over twist of a spring, with the operating point and how far it swings there.

import { type Paper, Plane, pathOf } from "../charts/plane";
import { type Figures, Picture } from "../charts/picture";
import { type Range, extent, padded } from "../charts/scales";
import { DASHES } from "../charts/style";
import type { Ask, Grid, Units } from "../protocol/messages";
import { type Told, useStore } from "../state/store";
import { amount, axisLabel, told as number } from "../units";
import { pointOf } from "./point";
import { Choose } from "./settings";
import { scaled, words } from "./values";
import type { Context, Shown, View } from "./view";

interface Characteristic {
  gear: string;
  element: string;
  label: string;
  elements: string[];
  angle: Grid;
  torque: Grid;
  friction: number;
  stages: { angle: number; stiffness: number }[];
  stops: number[];
  point: { speed: number; torque: number; angle: number; swing: number } | null;
}

function asks({ model, point, settings }: Context): Ask[] {
  const ask: Ask = { view: "characteristic", ...pointOf(point) };
  const element = settings.element;
  if (typeof element === "string" && (!model || model.elements.includes(element))) ask.element = element;
  else if (model && !model.landmarks.springs.length && !model.landmarks.clutch && model.elements.length) ask.element = model.elements[0];
  return [ask];
}

interface Curve {
  angle: Float64Array;
  torque: Float64Array;
}

/** The curve, shifted by friction: up on the way of rising twist, down on the way back. */
function curveOf(found: Characteristic, friction: number, units: Units): Curve {
  const torque = friction ? found.torque.data.map((value) => value + friction) : found.torque.data;
  return { angle: scaled(found.angle.data, units, "relative_angle"), torque: scaled(torque, units, "torque") };
}

function CharacteristicView({ told, variants, model, set }: Shown) {
  const found = told.answers[0] as Characteristic;
  const units = useStore((state) => state.start?.units ?? {});
  const own = found.friction ? [curveOf(found, found.friction, units), curveOf(found, -found.friction, units)] : [curveOf(found, 0, units)];
  const others = variants.flatMap(({ name, told: other }) => (other ? [{ name, curve: curveOf(other.answers[0] as Characteristic, 0, units) }] : []));
  const title = `Characteristic of ${found.label}`;
  return (
    <>
      <div className="settings" role="group" aria-label="Settings of the characteristic">
        <Choose label="Spring" options={[...new Set([...found.elements, ...model.elements])].map((name) => [name, words(name)])} value={found.element} put={(element) => set({ element })} />
        
      </div>
      <Picture title={title} ask={told.asks[0]} figures={() => figures(found, units)}>
        <Plane label={title} height={440} x={{ range: padded(extent(...own.map((curve) => curve.angle)), 0.02), label: axisLabel(units, "relative_angle", "twist") }} y={{ range: torques(found, own, units), label: axisLabel(units, "torque") }}>
          {(paper) => <Curves paper={paper} found={found} own={own} others={others} units={units} />}
        </Plane>
      </Picture>
      <Words found={found} others={others.map(({ name }) => name)} units={units} />
    </>
  );
}

const BEYOND = 1.4;

/** Torques worth to be seen: a stop is so stiff that beyond it nothing else would be. */
function torques(found: Characteristic, own: Curve[], units: Units): Range {
  const ends = found.stops.map((stop) => (BEYOND * torqueAt(found, stop)) / (units.torque?.factor ?? 1));
  return padded(ends.length ? extent(ends, [0]) : extent(...own.map((curve) => curve.torque)));
}

interface CurvesProps {
  paper: Paper;
  found: Characteristic;
  own: Curve[];
  others: { name: string; curve: Curve }[];
  units: Units;
}

function Curves({ paper, found, own, others, units }: CurvesProps) {
  const { look, top, height, left, width } = paper;
  const clip = { clipPath: "url(#characteristic-clip)" };
  const place = (angle: number) => paper.x.place(angle / (units.relative_angle?.factor ?? 1));
  const { point } = found;
  return (
    <>
      <clipPath id="characteristic-clip"><rect x={left} y={top} width={width} height={height} /></clipPath>
      {point && <rect x={place(point.angle - point.swing)} width={Math.max(place(point.angle + point.swing) - place(point.angle - point.swing), 1)} y={top} height={height} fill={look.colours[1]} fillOpacity={0.15} {...clip} />}
      <path d={`M${left} ${paper.y.place(0)}h${width}M${paper.x.place(0)} ${top}v${height}`} stroke={look.faint} {...clip} />
      {found.stops.map((stop) => <line key={stop} x1={place(stop)} x2={place(stop)} y1={top} y2={top + height} stroke={look.faint} strokeDasharray="6 4" {...clip} />)}
      {others.map(({ name, curve }, i) => <path key={name} d={pathOf(paper, curve.angle, curve.torque)} fill="none" stroke={look.colours[2 + i]} strokeWidth={1.5} strokeDasharray={DASHES[1 + (i % 3)].join(" ")} {...clip} />)}
      {own.map((curve, i) => <path key={i} d={pathOf(paper, curve.angle, curve.torque)} fill="none" stroke={look.colours[0]} strokeWidth={2.2} {...clip} />)}
      {point && <circle cx={place(point.angle)} cy={paper.y.place(torqueAt(found, point.angle) / (units.torque?.factor ?? 1))} r={6} fill={look.colours[1]} stroke={look.paper} strokeWidth={1.5} />}
    </>
  );
}

/** Torque of the spring at a twist, between the points of its curve. */
function torqueAt(found: Characteristic, angle: number): number {
  const { data } = found.angle;
  const next = Math.min(Math.max(data.findIndex((value) => value >= angle), 1), data.length - 1);
  const share = (angle - data[next - 1]) / (data[next] - data[next - 1]);
  return found.torque.data[next - 1] + share * (found.torque.data[next] - found.torque.data[next - 1]);
}

/** Where the spring is at the operating point, and how far it swings there. */
function pointText({ speed, torque, angle, swing }: NonNullable<Characteristic["point"]>, units: Units): string {
  const where = `At ${amount(units, "speed", speed)} and ${amount(units, "torque", torque)} mean engine torque`;
  return `${where}: twist ${amount(units, "relative_angle", angle)}, swinging by ±${amount(units, "relative_angle", swing, 3)} (half peak-to-peak, shaded).`;
}

function summary(told: Told, units: Units): string {
  const { point } = told.answers[0] as Characteristic;
  return point ? pointText(point, units) : "";
}

function Words({ found, others, units }: { found: Characteristic; others: string[]; units: Units }) {
  const { point } = found;
  return (
    <ul className="words">
      {point && <li>{pointText(point, units)}</li>}
      {found.stages.map((stage) => <li key={stage.angle}>{`Stiffness ${amount(units, "stiffness", stage.stiffness)} at a twist of ${amount(units, "relative_angle", stage.angle, 3)}.`}</li>)}
      {found.friction > 0 && <li>{`Friction beside the spring slips at ${amount(units, "torque", found.friction)}: the upper line is the way of rising twist.`}</li>}
      {others.length > 0 && <li>{`Dashed: ${others.join(", ")}.`}</li>}
    </ul>
  );
}

function figures(found: Characteristic, units: Units): Figures {
  const { angle, torque } = curveOf(found, 0, units);
  return { columns: [axisLabel(units, "relative_angle", "twist"), axisLabel(units, "torque")], rows: [...angle].map((value, i) => [number(value), number(torque[i])]) };
}

export const CHARACTERISTIC: View = { name: "characteristic", title: "Characteristic", asks, compares: true, component: CharacteristicView, summary };
