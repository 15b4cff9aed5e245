// The bar that says which colour stands for which value.

import { told } from "../units";
import type { Colours } from "./heat";
import { logTicks, ticks } from "./scales";

const HEIGHT = 14;
const STEPS = 48;

/** `width` in pixels; round values below, the label beside. */
export function ColourBar({ colours, label, width = 320 }: { colours: Colours; label: string; width?: number }) {
  const [low, high] = colours.range;
  const place = (value: number) => (width * Math.log(value / low)) / Math.log(high / low);
  const round = logTicks(colours.range);
  const marks = (round.length > 3 ? round : ticks(colours.range, 6)).filter((value, i, all) => i === 0 || place(value) - place(all[i - 1]) > 26);
  return (
    <div className="colourbar">
      <svg width={width + 40} height={HEIGHT + 18} role="img" aria-label={`Colours from ${told(low, 3)} to ${told(high, 3)}, ${label}`}>
        <g transform="translate(20 0)">
          {Array.from({ length: STEPS }, (_, i) => (
            <rect key={i} x={(i * width) / STEPS} width={width / STEPS + 0.5} height={HEIGHT} fill={`rgb(${colours.map((i + 0.5) / STEPS).join()})`} />
          ))}
          {marks.map((value) => <text key={value} x={place(value)} y={HEIGHT + 13} textAnchor="middle" fill="currentColor">{told(value)}</text>)}
        </g>
      </svg>
      <span>{label}</span>
    </div>
  );
}
