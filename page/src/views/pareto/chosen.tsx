// One design of a study: what it is made of and what it comes to, to be taken over or kept beside the present one.

import type { Field, ModelAnswer, Units } from "../../protocol/messages";
import { endRun, setChanges, tell } from "../../state/actions";
import { current, designOf, useStore } from "../../state/store";
import { type Value, withValues } from "../../state/takeover";
import { keepVariant } from "../../state/variants";
import { amount, told } from "../../units";
import { percent } from "../comparison/figures";
import { type Front, isOnFront, isWithin } from "./designs";

function fieldAt(model: ModelAnswer, path: string): Field | undefined {
  for (const group of model.groups) for (const field of group.fields) if (field.path === path) return field;
  return undefined;
}

function valuesOf(front: Front, index: number, model: ModelAnswer, units: Units): Value[] {
  return front.parameters.map(({ path, values }) => {
    const quantity = fieldAt(model, path)?.quantity;
    return { path, value: Array.isArray(values) ? values[index] : values.data[index], unit: quantity ? units[quantity] : undefined };
  });
}

function nameOf(front: Front, index: number): string {
  return front.role?.[index].replaceAll("_", " ") || `${front.name} design ${index + 1}`;
}

export function Chosen({ front, index, model }: { front: Front; index: number; model: ModelAnswer }) {
  const units = useStore((state) => state.start?.units ?? {});
  const name = nameOf(front, index);
  const values = valuesOf(front, index, model, units);
  const unknown = values.filter(({ path }) => !fieldAt(model, path));
  const take = () => {
    endRun();
    setChanges(withValues(current().history.present, values));
    tell(`The values of ${name} are in the present design; undo gives back what they replaced.`);
  };
  const keep = () => {
    const design = designOf(current());
    if (keepVariant(name, { ...design, changes: withValues(design.changes, values) })) tell(`${name} is kept as a variant; see the comparison.`);
  };
  const words = [isOnFront(front, index) && "on the front", !isWithin(front, index) && "beyond limits"].filter(Boolean).join(", ");
  return (
    <section className="chosen" aria-label={`Design ${name}`}>
      <h3>{name} {words && <small>{words}</small>}</h3>
      <p>
        <button type="button" onClick={take}>Take this design over</button> <button type="button" onClick={keep}>Keep as variant</button>
      </p>
      {unknown.length > 0 && <p className="banner" role="status">{`The present model has no ${unknown.map(({ path }) => path).join(", ")}: the study may be about another one.`}</p>}
      <div className="beside" aria-live="polite">
        <Parameters values={values} model={model} units={units} />
        <Criteria front={front} index={index} units={units} />
      </div>
    </section>
  );
}

function Parameters({ values, model, units }: { values: Value[]; model: ModelAnswer; units: Units }) {
  return (
    <table>
      <caption>Its values</caption>
      <thead>
        <tr><th scope="col">value</th><th scope="col">here</th><th scope="col">present</th></tr>
      </thead>
      <tbody>
        {values.map(({ path, value }) => {
          const field = fieldAt(model, path);
          const written = typeof value === "string" ? value : field?.quantity ? amount(units, field.quantity, value) : told(value);
          return <tr key={path}><th scope="row" title={path}>{path.replaceAll("_", " ")}</th><td>{written}</td><td>{field?.quantity && field.value !== null ? amount(units, field.quantity, field.value) : (field?.text ?? "–")}</td></tr>;
        })}
      </tbody>
    </table>
  );
}

function limitText(limits: [number | null, number | null] | null, quantity: string, units: Units): string {
  const [least, most] = limits ?? [null, null];
  return [least !== null && `at least ${amount(units, quantity, least)}`, most !== null && `at most ${amount(units, quantity, most)}`].filter(Boolean).join(", ");
}

function Criteria({ front, index, units }: { front: Front; index: number; units: Units }) {
  const nominal = front.role?.indexOf("nominal") ?? -1;
  const difference = (values: Float64Array) => (nominal >= 0 && values[nominal] ? percent((values[index] - values[nominal]) / Math.abs(values[nominal])) : "");
  return (
    <table>
      <caption>What it comes to</caption>
      <thead>
        <tr><th scope="col">figure</th><th scope="col">here</th>{nominal >= 0 && <th scope="col">to nominal</th>}<th scope="col">limit</th></tr>
      </thead>
      <tbody>
        {front.criteria.map(({ name, label, quantity, limits, values }) => (
          <tr key={name}>
            <th scope="row">{label}</th>
            <td>{amount(units, quantity, values.data[index])}</td>
            {nominal >= 0 && <td>{difference(values.data)}</td>}
            <td>{limitText(limits, quantity, units)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
