// A picture with its title, its figures as a table for who cannot see it, and its export as a file.

import { type ReactNode, useState } from "react";
import { exported } from "../protocol/client";
import type { Ask } from "../protocol/messages";
import { attempt, handOver } from "../parts/downloads";
import { Menu } from "../parts/menu";
import { current, designOf } from "../state/store";
import { useLook } from "./style";

export interface Figures {
  columns: string[];
  rows: (string | number)[][];
}

interface PictureProps {
  title: string;
  note?: string;
  /** What the server draws when the picture is exported. */
  ask?: Ask;
  /** Whether kept variants are in the picture. */
  compared?: boolean;
  figures: () => Figures;
  children: ReactNode;
}

const FORMATS = ["png", "svg", "csv"] as const;

export function Picture({ title, note, ask, compared, figures, children }: PictureProps) {
  const [asTable, setAsTable] = useState(false);
  return (
    <figure className="picture">
      <figcaption>
        <h3>{title}</h3>
        {note && <small>{note}</small>}
        <button type="button" aria-pressed={asTable} onClick={() => setAsTable(!asTable)}>Figures</button>
        {ask && <Export ask={ask} compared={compared ?? false} />}
      </figcaption>
      {asTable ? <Table caption={title} {...figures()} /> : children}
    </figure>
  );
}

function Export({ ask, compared }: { ask: Ask; compared: boolean }) {
  const { dark } = useLook();
  const save = async (format: (typeof FORMATS)[number]) => {
    const state = current();
    const variants = [{ name: state.name, design: designOf(state) }, ...(compared ? state.variants : [])];
    handOver(await exported(variants, ask, format, dark));
  };
  return (
    <Menu label="Export">
      {FORMATS.map((format) => <button key={format} type="button" onClick={() => void attempt("Export", () => save(format))}>{format.toUpperCase()}</button>)}
    </Menu>
  );
}

export function Table({ caption, columns, rows }: Figures & { caption: string }) {
  return (
    <div className="scroll" role="region" aria-label={caption} tabIndex={0}>
      <table>
        <caption>{caption}</caption>
        <thead>
          <tr>{columns.map((column, i) => <th key={i} scope="col">{column}</th>)}</tr>
        </thead>
        <tbody>
          {rows.map((row, i) => (
            <tr key={i}>{row.map((value, j) => (j === 0 ? <th key={j} scope="row">{value}</th> : <td key={j}>{value}</td>))}</tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
