// The powertrain as discs and springs: a disc's height is the fourth root of its inertia, as the diameter of a steel
// disc of one thickness would be. Parts are chosen by click or key.

import { type KeyboardEvent, memo } from "react";
import { useWidth } from "../charts/size";
import { type Look, useLook } from "../charts/style";
import type { ChainLink, ChainNode, ModelAnswer } from "../protocol/messages";
import { select } from "../state/actions";
import { useStore } from "../state/store";
import { amount } from "../units";

const NARROWEST = 44;
const WIDEST = 120;
const LEVEL = 16;
const THICK = 13;
const TALLEST = 36;
const MIDDLE = 46;
const LANE = 12;

interface Place {
  x: number;
  y: number;
  half: number;
}

/** Where each disc stands in a picture of some width, and half its height. */
function placesOf(nodes: ChainNode[], width: number): Map<string, Place> {
  const left = Math.min(...nodes.map((node) => node.x));
  const top = Math.max(...nodes.map((node) => node.y));
  const long = Math.max(...nodes.map((node) => node.x)) - left || 1;
  const step = Math.min(Math.max((width - 90) / long, NARROWEST), WIDEST);
  const largest = Math.max(...nodes.map((node) => node.inertia), 1e-12) ** 0.25;
  return new Map(
    nodes.map(({ name, x, y, inertia }) => {
      const half = Math.max((TALLEST * Math.max(inertia, 0) ** 0.25) / largest, 3);
      return [name, { x: 30 + (x - left) * step, y: MIDDLE + (top - y) * LEVEL, half }];
    }),
  );
}

export function Chain() {
  const model = useStore((state) => state.model);
  const part = useStore((state) => state.part);
  return model && <Drawing model={model} chosen={part} />;
}

const Drawing = memo(function Drawing({ model, chosen }: { model: ModelAnswer; chosen: string }) {
  const look = useLook();
  const units = useStore((state) => state.start?.units ?? {});
  const { nodes, links } = model.chain;
  const [ref, room] = useWidth<HTMLDivElement>();
  const places = placesOf(nodes, room);
  const width = Math.max(...[...places.values()].map((place) => place.x)) + 60;
  const height = Math.max(...[...places.values()].map((place) => place.y)) + 124;
  const inertia = (node: ChainNode) => `${node.label}, ${amount(units, "inertia", node.inertia)} at engine speed`;
  return (
    <div ref={ref} className="chain" role="group" aria-label="The powertrain as a chain of discs and springs">
      <svg width={width} height={height} viewBox={`0 0 ${width} ${height}`}>
        {links.map((link, i) => (
          <Part key={link.name} name={link.name} path={pathOf(link, nodes)} chosen={chosen} told={[link.label, link.told].filter(Boolean).join(", ")}>
            <Link link={link} places={places} colour={colourOf(link, model, look)} look={look} lane={laneOf(links, i)} />
          </Part>
        ))}
        {nodes.map((node) => (
          <Part key={node.name} name={node.name} path={node.path} chosen={chosen} told={inertia(node)}>
            <Disc node={node} place={places.get(node.name)!} lit={node.path.startsWith("absorber")} beside={node.y % 6 > 0} look={look} />
          </Part>
        ))}
      </svg>
    </div>
  );
});

/** The key path of a link; of one without a path of its own that of the parts it is inside of. */
function pathOf(link: ChainLink, nodes: ChainNode[]): string {
  if (link.path) return link.path;
  const paths = link.nodes.map((name) => nodes.find((node) => node.name === name)?.path ?? "");
  return paths.every((path) => path === paths[0]) ? paths[0] : "";
}

/** How many links join the same nodes before this one: they are drawn side by side. */
function laneOf(links: ChainLink[], index: number): number {
  const ends = (link: ChainLink) => [...link.nodes].sort().join(" ");
  return links.slice(0, index).filter((link) => ends(link) === ends(links[index])).length;
}

function colourOf(link: ChainLink, model: ModelAnswer, look: Look): string {
  if (pathOf(link, model.chain.nodes).startsWith("absorber")) return look.colours[1];
  return link.name === model.landmarks.clutch ? look.colours[2] : look.ink;
}

interface PartProps {
  name: string;
  path: string;
  chosen: string;
  told: string;
  children: React.ReactNode;
}

function Part({ name, path, chosen, told, children }: PartProps) {
  const choose = () => select(path, name);
  const pressed = (event: KeyboardEvent) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    choose();
  };
  if (!path) return <g><title>{told}</title>{children}</g>;
  return (
    <g role="button" tabIndex={0} className="part" aria-pressed={name === chosen} aria-label={told} onClick={choose} onKeyDown={pressed}>
      <title>{told}</title>
      {children}
    </g>
  );
}

interface DiscProps {
  node: ChainNode;
  place: Place;
  lit: boolean;
  /** On a branch above the chain, where a label below would be in the way. */
  beside: boolean;
  look: Look;
}

function Disc({ node, place, lit, beside, look }: DiscProps) {
  const { x, y, half } = place;
  return (
    <>
      <rect x={x - THICK / 2} y={y - half} width={THICK} height={2 * half} rx={2} fill={lit ? look.colours[1] : look.colours[0]} />
      <text transform={beside ? `translate(${x + THICK} ${y - half + 8})` : `translate(${x + 3} ${y + TALLEST + 10}) rotate(50)`} fill={look.ink}>{node.label}</text>
    </>
  );
}

const LOOKS: { [kind: string]: string } = { gear: "2 3", damper: "7 4", planets: "6 3 2 3", friction: "2 4" };

interface LinkProps {
  link: ChainLink;
  places: Map<string, Place>;
  colour: string;
  look: Look;
  lane: number;
}

function Link({ link, places, colour, look, lane }: LinkProps) {
  const [first, ...others] = link.nodes.map((name) => places.get(name)!);
  const path = others.map((place) => wayOf(first, place, link.kind, lane)).join("");
  return (
    <>
      <path d={path} className="hit" stroke="transparent" strokeWidth={16} fill="none" />
      <path d={path} stroke={colour} strokeWidth={link.kind === "gear" ? 3 : 1.7} strokeDasharray={LOOKS[link.kind]} fill="none" />
      {link.kind === "gear" && <circle cx={(first.x + others[0].x) / 2} cy={(first.y + others[0].y) / 2} r={5} fill={look.paper} stroke={colour} strokeWidth={1.5} />}
    </>
  );
}

/** A spring is a zigzag, anything else a line; neighbours of neighbours are joined by an arc above the discs. */
function wayOf(a: Place, b: Place, kind: string, lane: number): string {
  const far = Math.abs(b.x - a.x) > 1.5 * WIDEST;
  if (far) return `M${a.x} ${a.y}Q${(a.x + b.x) / 2} ${Math.min(a.y, b.y) - 56} ${b.x} ${b.y}`;
  if (lane) return `M${a.x} ${a.y}v${LANE * lane}L${b.x} ${b.y + LANE * lane}v${-LANE * lane}`;
  if (kind !== "spring") return `M${a.x} ${a.y}L${b.x} ${b.y}`;
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const length = Math.hypot(dx, dy) || 1;
  const at = (share: number, aside: number) => `${(a.x + share * dx - (aside * dy) / length).toFixed(1)} ${(a.y + share * dy + (aside * dx) / length).toFixed(1)}`;
  const turns = [0.25, 0.325, 0.4, 0.475, 0.55, 0.625, 0.7].map((share, i) => `L${at(share + 0.0125, i % 2 ? 6 : -6)}`);
  return `M${at(0, 0)}L${at(0.2, 0)}${turns.join("")}L${at(0.78, 0)}L${at(1, 0)}`;
}
