// The criteria of all designs: the best marked, the others by their difference to the reference.

import { Picture } from "../../charts/picture";
import type { Ask } from "../../protocol/messages";
import { useStore } from "../../state/store";
import { dropVariant, moveVariantUp, renameVariant, takeBack } from "../../state/variants";
import { amount, axisLabel, shown, told } from "../../units";
import { type Criterion, type Row, percent, rowsOf } from "./figures";

interface CriteriaProps {
  names: string[];
  criteria: (Criterion[] | null)[];
  reference: number;
  gear: string;
  ask: Ask;
}

export function CriteriaTable({ names, criteria, reference, gear, ask }: CriteriaProps) {
  const units = useStore((state) => state.start?.units ?? {});
  const rows = rowsOf(criteria, reference);
  const title = `Criteria at full load${gear ? `, gear ${gear}` : ""}`;
  const figures = () => ({
    columns: ["criterion", ...names],
    rows: rows.map((row) => [axisLabel(units, row.quantity, row.label), ...row.values.map((value) => (value === null ? "–" : told(shown(units, row.quantity, value), 6)))]),
  });
  return (
    <Picture title={title} note="★ best" ask={ask} formats={["csv"]} compared={names.length > 1} figures={figures}>
      <div className="scroll compared" role="region" aria-label={title} tabIndex={0}>
        <table>
          <thead>
            <tr>
              <th scope="col">criterion</th>
              {names.map((name, i) => <th key={i} scope="col">{i === 0 ? name : <VariantHead index={i - 1} name={name} />}</th>)}
            </tr>
          </thead>
          <tbody>
            {rows.map((row) => (
              <tr key={row.name}>
                <th scope="row">{row.label}</th>
                {names.map((_, i) => <Cell key={i} row={row} index={i} isReference={i === reference} />)}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Picture>
  );
}

function Cell({ row, index, isReference }: { row: Row; index: number; isReference: boolean }) {
  const units = useStore((state) => state.start?.units ?? {});
  const [value, difference] = [row.values[index], row.differences[index]];
  if (value === null) return <td>–</td>;
  return (
    <td className={row.best[index] ? "best" : undefined}>
      {row.best[index] && <span role="img" aria-label="best">★ </span>}
      {amount(units, row.quantity, value)}
      {!isReference && difference !== null && <small>{percent(difference)}</small>}
    </td>
  );
}

function VariantHead({ index, name }: { index: number; name: string }) {
  const isAnswered = useStore((state) => state.variantsTold.comparison?.[index] !== undefined);
  return (
    <div className="variant">
      <input type="text" maxLength={60} aria-label={`Name of variant ${index + 1}`} value={name} onChange={(event) => renameVariant(index, event.target.value)} onBlur={() => name.trim() || renameVariant(index, `variant ${index + 1}`)} />
      <span>
        <button type="button" onClick={() => takeBack(index)} title="Make it the present design">Take back</button>
        <button type="button" disabled={index === 0} onClick={() => moveVariantUp(index)} aria-label={`Move ${name} to the left`} title="To the left">←</button>
        <button type="button" onClick={() => dropVariant(index)} aria-label={`Remove ${name}`} title="Remove">×</button>
      </span>
      {!isAnswered && <small role="status">no answer yet, or none for this design</small>}
    </div>
  );
}
