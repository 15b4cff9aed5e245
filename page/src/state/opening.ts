// Model files from the user's disk, with the tables that they name.

import { opened } from "../protocol/client";
import { tell } from "./actions";
import { openDesign } from "./keeping";
import { current, update } from "./store";

const MODEL = /\.(ya?ml|json)$/i;

/** What was opened and still lacks files that it names. */
export interface Incomplete {
  name: string;
  text: string;
  files: Record<string, string>;
  missing: string[];
}

/** Reads a file as the text that it holds; throws for one that is no UTF-8. */
async function textOf(file: File): Promise<string> {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
  } catch {
    throw new Error(`${file.name} is no text in UTF-8`);
  }
}

async function textsOf(files: File[]): Promise<Record<string, string>> {
  return Object.fromEntries(await Promise.all(files.map(async (file) => [file.name, await textOf(file)])));
}

/** A model file with what it names; or the files that one opened before still lacks. */
export async function openFiles(chosen: File[]): Promise<void> {
  const most = current().start?.limits.body ?? Infinity;
  const large = chosen.find((file) => file.size > most);
  if (large) throw new Error(`${large.name} holds ${(large.size / 1e6).toFixed(1)} MB; ${(most / 1e6).toFixed(0)} MB are allowed`);
  const models = chosen.filter((file) => MODEL.test(file.name));
  const waiting = current().incomplete;
  const texts = await textsOf(chosen.filter((file) => !MODEL.test(file.name)));
  if (models.length === 1) return open(models[0].name, await textOf(models[0]), texts);
  if (models.length > 1) throw new Error("one model file at a time is opened");
  if (waiting === null) throw new Error("a model file (.yaml or .json) is wanted, with the tables that it names");
  return open(waiting.name, waiting.text, { ...waiting.files, ...texts });
}

async function open(name: string, text: string, files: Record<string, string>): Promise<void> {
  const { design, missing } = await opened(text, files);
  if (missing.length) {
    update({ incomplete: { name, text, files, missing } });
    return tell("");
  }
  update({ incomplete: null });
  openDesign(design, name);
}
