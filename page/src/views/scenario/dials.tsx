// Twists of connections on dials that move with the player: the angle between a spring's two sides, drawn larger than it is.

import { useMemo } from "react";
import { extent } from "../../charts/scales";
import { useLook } from "../../charts/style";
import { useStore } from "../../state/store";
import { amount, told } from "../../units";
import { words } from "../values";
import { type Channel, type Run, parts, slips, valueAt } from "./figures";

const RADIUS = 38;
/** The largest twist, or the stop beyond it, stands at this angle [rad]. */
const WIDEST = 1.2;

export function Dials({ run, time }: { run: Run; time: number }) {
  const twists = run.channels.filter((channel) => parts(channel)[0] === "twist" && !slips(channel));
  if (!twists.length) return null;
  return (
    <div className="dials" role="group" aria-label="Twists of the connections, angles exaggerated">
      {twists.map((channel) => <Dial key={channel.name} channel={channel} run={run} time={time} />)}
    </div>
  );
}

function Dial({ channel, run, time }: { channel: Channel; run: Run; time: number }) {
  const look = useLook();
  const units = useStore((state) => state.start?.units ?? {});
  const [, place] = parts(channel);
  const [low, high] = useMemo(() => extent(channel.values.data), [channel]);
  const most = Math.max(Math.abs(low), Math.abs(high)) || 1;
  const stops = (run.stops[place] ?? []).filter((stop) => Math.abs(stop) < 3 * most);
  const gain = WIDEST / Math.max(most, ...stops.map(Math.abs));
  const twist = valueAt(run.time.data, channel.values.data, time);
  const end = (angle: number, radius: number) => `${(radius * Math.sin(angle * gain)).toFixed(2)} ${(-radius * Math.cos(angle * gain)).toFixed(2)}`;
  return (
    <figure>
      <svg width="104" height="70" viewBox="-52 -46 104 70" role="img" aria-label={`Twist of ${words(place)}: ${amount(units, "relative_angle", twist)}`}>
        <path d={`M${end(low, RADIUS)}A${RADIUS} ${RADIUS} 0 0 1 ${end(high, RADIUS)}`} fill="none" stroke={look.colours[0]} strokeOpacity={0.35} strokeWidth={8} />
        <path d={`M0 0L${end(0, RADIUS + 4)}`} stroke={look.faint} strokeWidth={2} strokeDasharray="3 3" />
        {stops.map((stop) => <path key={stop} d={`M${end(stop, RADIUS - 9)}L${end(stop, RADIUS + 7)}`} stroke={look.colours[1]} strokeWidth={3} />)}
        <path d={`M0 0L${end(twist, RADIUS)}`} stroke={look.ink} strokeWidth={3} strokeLinecap="round" />
        <circle r={5} fill={look.ink} />
      </svg>
      <figcaption>
        {words(place)} <b>{amount(units, "relative_angle", twist, 3)}</b>
        <small>{`drawn × ${told(gain, 2)}`}</small>
      </figcaption>
    </figure>
  );
}
