// Natural modes: their shapes along the chain, moving, and where their energy is.

import { useMemo } from "react";
import { type Paper, Plane } from "../charts/plane";
import { type Figures, Picture } from "../charts/picture";
import { useCalm } from "../charts/style";
import { row } from "../protocol/frame";
import type { Ask, Grid, ModelAnswer, Units } from "../protocol/messages";
import { type Told, useStore } from "../state/store";
import { amount, told as number } from "../units";
import { pointOf } from "./point";
import { words } from "./values";
import type { Context, Shown, View } from "./view";

interface Modes {
  gear: string;
  torque: number;
  speed: number;
  order: number | null;
  name: string[];
  absorber_mode: string;
  nodes: string[];
  elements: string[];
  masses: string[];
  frequency: Grid;
  damping_ratio: Grid;
  order_speed: Grid | null;
  shape: Grid;
  elastic_share: Grid;
  kinetic_share: Grid;
}

function asks({ point }: Context): Ask[] {
  return [{ view: "modes", ...pointOf(point) }];
}

function ModesView({ told, variants, model, settings, set }: Shown) {
  const found = told.answers[0] as Modes;
  const units = useStore((state) => state.start?.units ?? {});
  const asked = typeof settings.mode === "number" ? settings.mode : firstShown(found);
  const mode = Math.min(asked, found.name.length - 1);
  const others = variants.map(({ name, told: other }) => ({ name, found: other?.answers[0] as Modes | undefined }));
  const point = `${found.gear ? `gear ${found.gear}, ` : ""}${amount(units, "torque", found.torque)}, ${amount(units, "speed", found.speed)}`;
  const title = `${heading(found, mode)}, ${amount(units, "frequency", found.frequency.data[mode])}`;
  return (
    <>
      <ModeTable found={found} others={others} mode={mode} units={units} choose={(index) => set({ mode: index })} />
      <Picture title={title} note={point} ask={told.asks[0]} figures={() => shapeFigures(found, mode)}>
        <ShapePlot found={found} model={model} mode={mode} still={settings.still === true} put={(still) => set({ still })} />
      </Picture>
      <div className="beside">
        <Shares title="Elastic energy" names={found.elements} shares={row(found.elastic_share, mode)} />
        <Shares title="Kinetic energy" names={found.masses} shares={row(found.kinetic_share, mode)} />
      </div>
    </>
  );
}

/** The absorber's own mode, or the first that is no turning as one. */
function firstShown(found: Modes): number {
  const own = found.name.indexOf(found.absorber_mode);
  return own < 0 ? firstElastic(found) : own;
}

/** The first mode that is no turning as one. */
function firstElastic(found: Modes): number {
  return Math.max(found.frequency.data.findIndex((value) => value > 1e-3), 0);
}

function heading(found: Modes, mode: number): string {
  return `Mode ${mode + 1}${found.name[mode] ? `: ${words(found.name[mode])}` : ""}`;
}

interface TableProps {
  found: Modes;
  others: { name: string; found: Modes | undefined }[];
  mode: number;
  units: Units;
  choose: (mode: number) => void;
}

function ModeTable({ found, others, mode, units, choose }: TableProps) {
  return (
    <div className="scroll modes" role="region" aria-label="Modes" tabIndex={0}>
      <table>
        <caption className="hidden">Modes; a name shows the shape</caption>
        <thead>
          <tr>
            <th scope="col">mode</th>
            <th scope="col">frequency [Hz]</th>
            {others.map(({ name }) => <th key={name} scope="col">{name} [Hz]</th>)}
            <th scope="col">damping ratio [%]</th>
            {found.order_speed && <th scope="col">order {found.order} at [rpm]</th>}
          </tr>
        </thead>
        <tbody>
          {found.name.map((name, index) => (
            <tr key={index} className={index === mode ? "chosen" : ""}>
              <th scope="row">
                <button type="button" aria-pressed={index === mode} onClick={() => choose(index)}>{index + 1}{name && ` ${words(name)}`}</button>
              </th>
              <td>{number(found.frequency.data[index])}</td>
              {others.map((other) => <td key={other.name}>{other.found ? number(other.found.frequency.data[index] ?? NaN) : "…"}</td>)}
              <td>{number(100 * found.damping_ratio.data[index], 3)}</td>
              {found.order_speed && <td>{number(found.order_speed.data[index] / (units.speed?.factor ?? 1))}</td>}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function shapeFigures(found: Modes, mode: number): Figures {
  const shape = row(found.shape, mode);
  return { columns: ["node", "shape, largest angle one"], rows: found.nodes.map((node, i) => [words(node), number(shape[i])]) };
}

interface ShapeProps {
  found: Modes;
  model: ModelAnswer;
  mode: number;
  still: boolean;
  put: (still: boolean) => void;
}

function ShapePlot({ found, model, mode, still, put }: ShapeProps) {
  const calm = useCalm();
  const shape = row(found.shape, mode);
  const places = useMemo(() => chainOrder(found.nodes, model), [found.nodes, model]);
  const isStill = still || calm;
  const values = places.map((node) => shape[node]);
  return (
    <>
      <Plane label={`Shape of mode ${mode + 1} along the chain`} height={260} slanted x={{ range: [-0.6, places.length - 0.4], label: "", marks: places.map((node, i) => [i, words(found.nodes[node])]) }} y={{ range: [-1.1, 1.1], label: "angle, largest one" }} before={(paper) => !isStill && <Swinging paper={paper} values={values} />}>
        {(paper) => <Shape paper={paper} values={values} still={isStill} />}
      </Plane>
      {!calm && <button type="button" aria-pressed={!still} onClick={() => put(!still)}>{still ? "Move" : "Hold still"}</button>}
    </>
  );
}

/** Indices of the nodes from left to right, as the chain is drawn. */
function chainOrder(nodes: string[], model: ModelAnswer): number[] {
  const places = new Map(model.chain.nodes.map((node) => [node.name, node.x + 0.01 * node.y]));
  return nodes.map((_, i) => i).sort((a, b) => (places.get(nodes[a]) ?? a) - (places.get(nodes[b]) ?? b));
}

function wayOf(paper: Paper, values: number[]): string {
  return values.map((value, i) => `${i ? "L" : "M"}${paper.x.place(i).toFixed(1)} ${paper.y.place(value).toFixed(1)}`).join("");
}

function Shape({ paper, values, still }: { paper: Paper; values: number[]; still: boolean }) {
  const { y, look } = paper;
  const bars = values.map((value, i) => `M${paper.x.place(i).toFixed(1)} ${y.place(0)}V${y.place(value).toFixed(1)}`).join("");
  return (
    <>
      <path d={wayOf(paper, values)} fill="none" stroke={look.colours[0]} strokeWidth={2} strokeOpacity={still ? 1 : 0.3} />
      {still && <path d={bars} stroke={look.colours[0]} strokeWidth={6} strokeOpacity={0.65} />}
    </>
  );
}

/** The shape in a layer of its own, which the style sheet swings about zero: no script runs while it moves. */
function Swinging({ paper, values }: { paper: Paper; values: number[] }) {
  const { y, look, left, width, top, height } = paper;
  const bars = values.map((value, i) => `M${paper.x.place(i).toFixed(1)} ${y.place(0)}V${y.place(value).toFixed(1)}`).join("");
  return (
    <svg className="swinging" aria-hidden="true" width={left + width} height={top + height} style={{ transformOrigin: `0 ${y.place(0)}px` }}>
      <path d={wayOf(paper, values)} fill="none" stroke={look.colours[0]} strokeWidth={2} />
      <path d={bars} stroke={look.colours[0]} strokeWidth={6} strokeOpacity={0.65} />
    </svg>
  );
}

const MOST_SHARES = 8;

function Shares({ title, names, shares }: { title: string; names: string[]; shares: Float64Array }) {
  const largest = [...shares.keys()].sort((a, b) => shares[b] - shares[a]).slice(0, MOST_SHARES).filter((i) => shares[i] > 0.005);
  return (
    <table className="shares">
      <caption>{title}</caption>
      <tbody>
        {largest.map((i) => (
          <tr key={names[i]}>
            <th scope="row">{words(names[i])}</th>
            <td>{number(100 * shares[i], 3)} %</td>
            <td aria-hidden="true"><span style={{ width: `${100 * shares[i]}%` }} /></td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

const TOLD = 5;

/** The lowest elastic modes. */
function summary(told: Told, units: Units): string {
  const found = told.answers[0] as Modes;
  const first = firstElastic(found);
  const modes = found.name.slice(first, first + TOLD).map((name, i) => `${words(name) || `mode ${first + i + 1}`} ${amount(units, "frequency", found.frequency.data[first + i])}`);
  return modes.join(", ");
}

export const MODES: View = { name: "modes", title: "Modes", asks, compares: true, component: ModesView, summary };
