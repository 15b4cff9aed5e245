// What the designs differ in: the values that were changed, by their key paths.

import type { Json } from "../../protocol/messages";
import { update, useStore } from "../../state/store";
import { differences } from "../../state/variants";

function wordsOf(value: Json | undefined): string {
  if (value === undefined) return "as in the file";
  if (value === null) return "removed";
  if (typeof value !== "object") return String(value);
  const type = Array.isArray(value) ? undefined : value.type;
  return typeof type === "string" ? type.replaceAll("_", " ") : JSON.stringify(value);
}

export function Changed({ names }: { names: string[] }) {
  const variants = useStore((state) => state.variants);
  const text = useStore((state) => state.text);
  const files = useStore((state) => state.files);
  const changes = useStore((state) => state.history.present);
  if (!variants.length) return null;
  const found = differences([{ text, files, changes }, ...variants.map(({ design }) => design)]);
  if (found === null) return <p className="note">The designs are of different model files, so their values are not listed one by one.</p>;
  if (!found.length) return <p className="note">The designs are alike: change a value, and it is listed here.</p>;
  return (
    <div className="scroll compared" role="region" aria-label="What the designs differ in" tabIndex={0}>
      <table>
        <caption>What they differ in</caption>
        <thead>
          <tr>
            <th scope="col">value</th>
            {names.map((name, i) => <th key={i} scope="col">{name}</th>)}
          </tr>
        </thead>
        <tbody>
          {found.map(({ path, values }) => (
            <tr key={path}>
              <th scope="row"><button type="button" className="plain" title="Show the field" onClick={() => update({ selected: path })}>{path}</button></th>
              {values.map((value, i) => <td key={i} title={typeof value === "object" && value ? JSON.stringify(value) : undefined}>{wordsOf(value)}</td>)}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
