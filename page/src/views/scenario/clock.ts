// The player's clock: it runs with the screen, slower or faster than the machine did, and stops at the end.

import { useEffect, useState } from "react";
import { useCalm } from "../../charts/style";

export interface Clock {
  time: number;
  plays: boolean;
  seek: (time: number) => void;
  toggle: () => void;
}

/** Between two pictures where motion is not wanted [s]. */
const CALM = 0.5;

export function useClock(begin: number, end: number, rate: number): Clock {
  const calm = useCalm();
  const [time, setTime] = useState(begin);
  const [plays, setPlays] = useState(false);
  const isOver = time >= end;
  useEffect(() => {
    if (!plays) return undefined;
    let last = performance.now();
    let frame = 0;
    const advance = (now: number) => {
      const passed = (now - last) / 1000;
      if (!calm || passed >= CALM) {
        last = now;
        setTime((before) => Math.min(before + passed * rate, end));
      }
      frame = requestAnimationFrame(advance);
    };
    frame = requestAnimationFrame(advance);
    return () => cancelAnimationFrame(frame);
  }, [plays, rate, end, calm]);
  useEffect(() => {
    if (isOver) setPlays(false);
  }, [isOver]);
  const seek = (to: number) => setTime(Math.min(Math.max(to, begin), end));
  const toggle = () => {
    if (!plays && isOver) setTime(begin);
    setPlays(!plays);
  };
  return { time, plays, seek, toggle };
}
