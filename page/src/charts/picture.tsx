// A picture with its title, its figures as a table for who cannot see it, and its export as a file.

import { type ReactNode, useState } from "react";
import { type Download, type Format, exported } from "../protocol/client";
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
  /** Instead of an ask: how else the picture is had as a file. */
  save?: (format: Format) => Promise<Download>;
  /** The files that can be had of it; all kinds by default. */
  formats?: Format[];
  figures: () => Figures;
  children: ReactNode;
}

const FORMATS: Format[] = ["png", "svg", "csv"];

export function Picture({ title, note, ask, compared, save, formats = FORMATS, figures, children }: PictureProps) {
  const [asTable, setAsTable] = useState(false);
  return (
    <figure className="picture">
      <figcaption>
        <h3>{title}</h3>
        {note && <small>{note}</small>}
        <button type="button" aria-pressed={asTable} onClick={() => setAsTable(!asTable)}>Figures</button>
        {save && <ExportMenu formats={formats} save={save} />}
        {ask && <Export ask={ask} compared={compared ?? false} formats={formats} />}
      </figcaption>
      {asTable ? <Table caption={title} {...figures()} /> : children}
    </figure>
  );
}

function Export({ ask, compared, formats }: { ask: Ask; compared: boolean; formats: Format[] }) {
  const { dark } = useLook();
  const save = (format: Format) => {
    const state = current();
    const variants = [{ name: state.name, design: designOf(state) }, ...(compared ? state.variants : [])];
    return exported(variants, ask, format, dark);
  };
  return <ExportMenu formats={formats} save={save} />;
}

function ExportMenu({ formats, save }: { formats: Format[]; save: (format: Format) => Promise<Download> }) {
  return (
    <Menu label="Export">
      {formats.map((format) => <button key={format} type="button" onClick={() => void attempt("Export", async () => handOver(await save(format)))}>{format.toUpperCase()}</button>)}
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
