// Open, save, share, report: the design's ways in and out.

import { useRef } from "react";
import * as client from "../protocol/client";
import { tell } from "../state/actions";
import { type Unsaved, linkOf, openDesign, showLink, takeWork, unsavedWork } from "../state/keeping";
import { openFiles } from "../state/opening";
import { current, designOf, update, useStore } from "../state/store";
import { attempt, handOver } from "./downloads";
import { Menu } from "./menu";

async function save(): Promise<void> {
  const state = current();
  const { text } = await client.saved(designOf(state));
  handOver({ blob: new Blob([text], { type: "application/yaml" }), name: state.name || "model.yaml" });
  update({ savedChanges: state.history.present });
  const tables = Object.keys(state.files);
  if (tables.length) tell(`Saved ${state.name}; keep it beside ${tables.join(", ")}, which it names.`);
}

async function share(): Promise<void> {
  const link = await linkOf(current());
  try {
    await navigator.clipboard.writeText(link);
    tell("The link to this design is in the clipboard; the design itself is in it, and on no server.");
  } catch {
    showLink(link);
    tell("The link to this design is in the address bar; the design itself is in it, and on no server.");
  }
}

async function report(): Promise<void> {
  const state = current();
  handOver(await client.report([{ name: state.name, design: designOf(state) }, ...state.variants]));
}

async function takeExample(name: string): Promise<void> {
  const found = await client.example(name);
  openDesign(found.design, found.name);
}

export function OpenMenu() {
  const examples = useStore((state) => state.start?.examples ?? []);
  const picker = useRef<HTMLInputElement>(null);
  const unsaved = unsavedWork();
  const picked = (files: FileList | null) => files && void attempt("Opening", () => openFiles([...files]));
  return (
    <>
      <Menu label="Open">
        <button type="button" onClick={() => picker.current?.click()}>A model file of yours …</button>
        {unsaved && <RestoreButton unsaved={unsaved} />}
        {examples.map(({ name, title }) => (
          <button key={name} type="button" onClick={() => void attempt("Opening", () => takeExample(name))}>{title ?? name}</button>
        ))}
      </Menu>
      <input ref={picker} className="hidden" type="file" multiple accept=".yaml,.yml,.json,.csv,.txt" aria-label="Model file and the tables that it names" tabIndex={-1} onChange={(event) => { picked(event.target.files); event.target.value = ""; }} />
    </>
  );
}

function RestoreButton({ unsaved }: { unsaved: Unsaved }) {
  const time = new Date(unsaved.time).toLocaleString();
  return <button type="button" onClick={() => void attempt("Restoring", async () => takeWork(unsaved.work))}>{`Unsaved work of ${time}: ${unsaved.work.name}`}</button>;
}

export function FileButtons() {
  return (
    <>
      <OpenMenu />
      <button type="button" onClick={() => void attempt("Saving", save)}>Save</button>
      <button type="button" onClick={() => void attempt("Sharing", share)}>Share</button>
      <button type="button" onClick={() => void attempt("The report", report)}>Report</button>
    </>
  );
}

/** Asks for the files that an opened model names and that did not come with it. */
export function MissingFiles() {
  const incomplete = useStore((state) => state.incomplete);
  const picker = useRef<HTMLInputElement>(null);
  if (incomplete === null) return null;
  const picked = (files: FileList | null) => files && void attempt("Opening", () => openFiles([...files]));
  return (
    <div className="banner" role="alert">
      {`${incomplete.name} names ${incomplete.missing.join(", ")}: `}
      <button type="button" onClick={() => picker.current?.click()}>Choose {incomplete.missing.length === 1 ? "it" : "them"}</button>
      <button type="button" onClick={() => update({ incomplete: null })}>Leave it</button>
      <input ref={picker} className="hidden" type="file" multiple aria-label="Files that the model names" tabIndex={-1} onChange={(event) => picked(event.target.files)} />
    </div>
  );
}
