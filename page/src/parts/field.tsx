// One value of the model: typed, stepped by keys or by a slider, and told at its place when it is wrong.

import { type KeyboardEvent, memo, useId, useRef, useState } from "react";
import type { Fault, Field, Json } from "../protocol/messages";
import { chooseValue, endRun, setValue } from "../state/actions";
import { countedText, scaledText, steppedText } from "../units";
import { KNOB_HELP, keyFactor } from "./knob";
import { faultText, limitsOf } from "./limits";

interface FieldProps {
  field: Field;
  /** What was typed; undefined where the file's value holds. */
  change: Json | undefined;
  /** Its faults as one text, so that a field is drawn anew only when they differ. */
  fault: string;
  marked: boolean;
}

export function faultsText(faults: Fault[]): string {
  return faults.map(faultText).join("\n");
}

export const FieldRow = memo(function FieldRow({ field, change, fault, marked }: FieldProps) {
  const id = useId();
  const help = [field.help, limitsOf(field)].filter(Boolean).join("; ");
  const props = { id, "aria-invalid": fault !== "", "aria-describedby": `${id}-help ${id}-fault` };
  return (
    <div className={`field${marked ? " marked" : ""}${change !== undefined ? " changed" : ""}`} data-path={field.path}>
      <label htmlFor={id}>{field.label}</label>
      <Input field={field} change={change} props={props} />
      {change !== undefined && (
        <button type="button" className="back" title="Back to the file's value" aria-label={`${field.label}: back to the file's value`} onClick={() => chooseValue(field.path, undefined)}>
          ↶
        </button>
      )}
      <small id={`${id}-help`}>{help}</small>
      <p id={`${id}-fault`} className="fault" aria-live="polite">{fault}</p>
    </div>
  );
});

interface InputProps {
  field: Field;
  change: Json | undefined;
  props: { id: string; "aria-invalid": boolean; "aria-describedby": string };
}

function Input({ field, change, props }: InputProps) {
  const text = typeof change === "string" ? change : field.text;
  if (field.kind === "switch") {
    const on = typeof change === "boolean" ? change : field.text === "true";
    return <input {...props} type="checkbox" checked={on} onChange={(event) => chooseValue(field.path, event.target.checked)} />;
  }
  if (field.kind === "choice") {
    return (
      <select {...props} value={text} onChange={(event) => chooseValue(field.path, event.target.value)}>
        {field.choices.includes(text) ? null : <option value={text}>{text || "–"}</option>}
        {field.choices.map((choice) => <option key={choice}>{choice}</option>)}
      </select>
    );
  }
  return <Typed field={field} text={text} props={props} />;
}

function Typed({ field, text, props }: { field: Field; text: string; props: InputProps["props"] }) {
  // An emptied field is no change yet: the file's value comes back if it is left so.
  const [empty, setEmpty] = useState(false);
  const isNumber = field.kind === "quantity" || field.kind === "number";
  const typed = (next: string) => {
    setEmpty(!next.trim());
    if (next.trim()) setValue(field.path, next);
  };
  const left = () => {
    if (empty) setValue(field.path, undefined);
    setEmpty(false);
    endRun();
  };
  const pressed = (event: KeyboardEvent) => {
    const factor = isNumber ? keyFactor(event) : null;
    const next = factor === null ? null : turned(field, text, factor);
    if (event.key === "Enter") endRun();
    if (next === null) return;
    event.preventDefault();
    typed(next);
  };
  const placeholder = field.value === null || !isNumber ? "" : `${field.value} ${field.unit}`.trim();
  return (
    <>
      <input {...props} className={isNumber ? "" : "long"} type="text" autoComplete="off" spellCheck={false} value={empty ? "" : text} placeholder={placeholder} title={isNumber ? KNOB_HELP : undefined} onChange={(event) => typed(event.target.value)} onBlur={left} onKeyDown={pressed} />
      {isNumber && field.unit && !/[^\d.eE+\-\s]/.test(text) && <span className="unit">{field.unit}</span>}
      {isNumber && !isCount(field, text) && scaledText(text, 1) !== null && <Slider label={field.label} text={text} put={typed} />}
    </>
  );
}

/** Plain whole numbers, as of channels or cylinders, are counts. */
function isCount(field: Field, text: string): boolean {
  return field.quantity === null && countedText(text, 1) !== null;
}

function turned(field: Field, text: string, factor: number): string | null {
  return isCount(field, text) ? countedText(text, factor) : steppedText(text, factor);
}

const DOUBLING = 50;

/** From a quarter to four times the value that it was when the slider was taken hold of. */
function Slider({ label, text, put }: { label: string; text: string; put: (text: string) => void }) {
  const held = useRef<string | null>(null);
  const [place, setPlace] = useState(0);
  const moved = (at: number) => {
    held.current ??= text;
    const next = scaledText(held.current, 2 ** (at / DOUBLING));
    setPlace(at);
    if (next !== null) put(next);
  };
  const released = () => {
    held.current = null;
    setPlace(0);
    endRun();
  };
  return (
    <input className="slider" type="range" min={-2 * DOUBLING} max={2 * DOUBLING} step={1} value={place} aria-label={`${label}, from a quarter to four times its value`} aria-valuetext={text} onChange={(event) => moved(Number(event.target.value))} onPointerUp={released} onBlur={released} tabIndex={-1} />
  );
}
