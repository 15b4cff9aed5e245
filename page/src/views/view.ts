// What a view is made of: a name, what it asks of the server under its settings, and how it shows the answers.

import type { ComponentType } from "react";
import type { Ask, ModelAnswer, Settings, Units } from "../protocol/messages";
import type { Point, Told } from "../state/store";

export interface Context {
  /** The model as last told; null before the first answer. */
  model: ModelAnswer | null;
  point: Point;
  settings: Settings;
}

export interface Shown {
  /** Answers in the order of the asks. */
  told: Told;
  /** The same of the variants kept for comparison; undefined where there is no answer yet. */
  variants: { name: string; told: Told | undefined }[];
  model: ModelAnswer;
  settings: Settings;
  set: (settings: Settings) => void;
}

export interface View {
  name: string;
  title: string;
  /** What to ask; nothing where the view has no use for answers. */
  asks: (context: Context) => Ask[];
  /** Whether kept variants are asked the same. */
  compares: boolean;
  component: ComponentType<Shown>;
  /** The answers in a sentence, read out to who cannot see the pictures change. */
  summary?: (told: Told, units: Units) => string;
}
