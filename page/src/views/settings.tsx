// The controls that settings of views are made of.

import { useId } from "react";
import { Menu } from "../parts/menu";
import { words } from "./values";

interface ChoicesProps {
  label: string;
  options: string[];
  chosen: string[];
  put: (chosen: string[]) => void;
}

/** Any of several, in the order of the options. */
export function Choices({ label, options, chosen, put }: ChoicesProps) {
  const toggled = (option: string) => options.filter((other) => (other === option) !== chosen.includes(other));
  return (
    <Menu label={`${label}: ${chosen.length ? chosen.map(words).join(", ") : "none"}`}>
      <fieldset className="choices">
        <legend className="hidden">{label}</legend>
        {options.map((option) => (
          <label key={option} className="check">
            <input type="checkbox" checked={chosen.includes(option)} onChange={() => put(toggled(option))} /> {words(option)}
          </label>
        ))}
      </fieldset>
    </Menu>
  );
}

interface ChooseProps {
  label: string;
  options: [value: string, label: string][];
  value: string;
  put: (value: string) => void;
}

/** One of several. */
export function Choose({ label, options, value, put }: ChooseProps) {
  const id = useId();
  return (
    <span className="choose">
      <label htmlFor={id}>{label}</label>
      <select id={id} value={value} onChange={(event) => put(event.target.value)}>
        {options.map(([name, text]) => <option key={name} value={name}>{text}</option>)}
      </select>
    </span>
  );
}
