// A run played back: signals over time with a cursor, twists on dials, what was done and what it came to.

import { type KeyboardEvent, useMemo, useState } from "react";
import { Table } from "../../charts/picture";
import { told } from "../../units";
import { Choose } from "../settings";
import { type Clock, useClock } from "./clock";
import { Dials } from "./dials";
import { type Run, panelsOf } from "./figures";
import { Motion } from "./motion";
import { SignalPanel } from "./panel";

const RATES = ["1", "0.5", "0.2", "0.1", "0.05", "0.02"];
const STEPS = 200;

export function Player({ run }: { run: Run }) {
  const time = run.time.data;
  const [begin, end] = [time[0] ?? 0, time[time.length - 1] ?? 0];
  const [rate, setRate] = useState("0.2");
  const clock = useClock(begin, end, Number(rate));
  const panels = useMemo(() => panelsOf(run), [run]);
  return (
    <section aria-label={run.title}>
      <h3>{run.title}</h3>
      {run.status !== "complete" && <p className="banner" role="status">{`The run is not complete: ${run.status}.`}</p>}
      <Controls clock={clock} begin={begin} end={end} rate={rate} setRate={setRate} />
      <Dials run={run} time={clock.time} />
      <Motion run={run} time={clock.time} />
      {panels.map((panel, i) => <SignalPanel key={`${panel.kind} ${panel.quantity}`} panel={panel} run={run} at={clock.time} seek={clock.seek} isFirst={i === 0} />)}
      <Events run={run} clock={clock} />
      <Measures run={run} />
      {run.notes.length > 0 && <ul className="words">{run.notes.map((note) => <li key={note}>{note}</li>)}</ul>}
    </section>
  );
}

interface ControlsProps {
  clock: Clock;
  begin: number;
  end: number;
  rate: string;
  setRate: (rate: string) => void;
}

/** Space plays and pauses, arrows step; buttons and lists keep the keys that they have themselves. */
function Controls({ clock, begin, end, rate, setRate }: ControlsProps) {
  const { time, plays, seek, toggle } = clock;
  const step = (end - begin) / STEPS;
  const pressed = (event: KeyboardEvent<HTMLDivElement>) => {
    const target = event.target as HTMLElement;
    const isOwn = target === event.currentTarget || (target instanceof HTMLInputElement && target.type === "range");
    const moves: { [key: string]: number } = { ArrowLeft: -step, ArrowRight: step, PageDown: -10 * step, PageUp: 10 * step, Home: -Infinity, End: Infinity };
    if (!isOwn || (event.key !== " " && moves[event.key] === undefined)) return;
    event.preventDefault();
    if (event.key === " ") toggle();
    else seek(time + moves[event.key]);
  };
  return (
    <div className="player" role="group" aria-label="Player: space plays and pauses, arrow keys step" tabIndex={0} onKeyDown={pressed}>
      <button type="button" onClick={toggle}>{plays ? "❚❚ Pause" : "▶ Play"}</button>
      <input type="range" aria-label="Time" min={begin} max={end} step="any" value={time} aria-valuetext={`${time.toFixed(3)} s`} onChange={(event) => seek(Number(event.target.value))} />
      <output>{`${time.toFixed(3)} of ${told(end)} s`}</output>
      <Choose label="Speed of play" options={RATES.map((value) => [value, `× ${value}`])} value={rate} put={setRate} />
    </div>
  );
}

function Events({ run, clock }: { run: Run; clock: Clock }) {
  if (!run.events.length) return null;
  return (
    <p className="events">
      <span>Events: </span>
      {run.events.map(({ time, text }, i) => <button key={i} type="button" aria-label={`Go to ${text}, ${time.toFixed(3)} s`} onClick={() => clock.seek(time)}>{`${time.toFixed(3)} s ${text}`}</button>)}
    </p>
  );
}

function Measures({ run }: { run: Run }) {
  return <Table caption="What it came to" columns={["measure", "value"]} rows={run.measures.map(({ label, text }) => [label, text])} />;
}
