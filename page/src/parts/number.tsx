// A number of the operating point, in the unit in which it is shown; empty is the model's own choice.

import { type KeyboardEvent, useId, useState } from "react";
import { useStore } from "../state/store";
import { shown, si, told, unitOf } from "../units";
import { KNOB_HELP, keyFactor } from "./knob";

interface NumberProps {
  label: string;
  quantity: string;
  /** SI; null is the model's own choice. */
  value: number | null;
  otherwise: string;
  /** Where steps begin while nothing was typed, SI. */
  from: number;
  range?: [number, number] | null;
  put: (value: number | null) => void;
}

export function NumberInput({ label, quantity, value, otherwise, from, range, put }: NumberProps) {
  const id = useId();
  const units = useStore((state) => state.start?.units ?? {});
  const [draft, setDraft] = useState<string | null>(null);
  const text = draft ?? (value === null ? "" : told(shown(units, quantity, value), 6));
  const isWrong = text.trim() !== "" && !Number.isFinite(Number(text));
  const typed = (next: string) => {
    setDraft(next);
    const number = Number(next);
    if (!next.trim()) put(null);
    else if (Number.isFinite(number)) put(si(units, quantity, number));
  };
  const pressed = (event: KeyboardEvent) => {
    const factor = keyFactor(event);
    if (factor === null) return;
    event.preventDefault();
    typed(told(shown(units, quantity, value ?? from) * factor, 6));
  };
  return (
    <div className="number">
      <label htmlFor={id}>{label}</label>
      <input id={id} type="text" inputMode="decimal" autoComplete="off" size={7} value={text} placeholder={otherwise} title={KNOB_HELP} aria-invalid={isWrong} onChange={(event) => typed(event.target.value)} onBlur={() => setDraft(null)} onKeyDown={pressed} />
      <span className="unit">{unitOf(units, quantity)}</span>
      {range && (
        <input className="slider" type="range" tabIndex={-1} aria-label={`${label}, slider`} min={range[0]} max={range[1]} step={(range[1] - range[0]) / 200} value={value ?? from} aria-valuetext={text || otherwise} onChange={(event) => put(Number(event.target.value))} />
      )}
    </div>
  );
}
