// The values of the part that was chosen in the drawing, block by block.

import { useEffect, useMemo, useRef, useState } from "react";
import type { Field, FieldGroup } from "../protocol/messages";
import { select } from "../state/actions";
import { useStore } from "../state/store";
import { AbsorberChoice } from "./absorber";
import { FieldRow, faultsText } from "./field";
import { isAbout } from "./limits";

/** The block that a key path leads to: the one with the longest path that it begins with. */
export function groupOf(groups: FieldGroup[], path: string): FieldGroup | undefined {
  const holds = (group: FieldGroup) => path === group.path || path.startsWith(`${group.path}.`);
  const holding = groups.filter(holds).sort((a, b) => b.path.length - a.path.length);
  return holding[0] ?? groups.find((group) => group.path.startsWith(`${path}.`)) ?? groups.find((group) => group.path === "absorber") ?? groups[1] ?? groups[0];
}

export function Fields() {
  const groups = useStore((state) => state.model?.groups);
  const selected = useStore((state) => state.selected);
  const absorber = useStore((state) => JSON.stringify(state.history.present.absorber));
  const group = useMemo(() => groups && groupOf(groups, selected), [groups, selected]);
  if (!groups || !group) return null;
  return (
    <section className="fields" aria-labelledby="fields-title">
      <h2 id="fields-title">
        <label>
          <span className="hidden">Values of </span>
          <select value={group.path} onChange={(event) => select(event.target.value)}>
            {groups.map(({ path, label }) => <option key={path} value={path}>{label}</option>)}
          </select>
        </label>
      </h2>
      {group.path === "absorber" && <AbsorberChoice />}
      <FieldList key={`${group.path} ${absorber}`} fields={group.fields} selected={selected} />
    </section>
  );
}

/** Tells the values that matter for what was chosen: those of the part, or those below the key path. */
function useMarked(selected: string, fields: Field[]): (path: string) => boolean {
  const part = useStore((state) => state.parts[state.part]);
  if (part?.length && part.length < fields.length) return (path) => part.includes(path);
  const isBlock = fields.every((field) => field.path.startsWith(`${selected}.`));
  return (path) => !isBlock && selected !== "" && (path === selected || path.startsWith(`${selected}.`));
}

function FieldList({ fields, selected }: { fields: Field[]; selected: string }) {
  const list = useRef<HTMLDivElement>(null);
  const changes = useStore((state) => state.history.present);
  const part = useStore((state) => state.part);
  const marked = useMarked(selected, fields);
  useEffect(() => list.current?.querySelector(".marked")?.scrollIntoView({ block: "nearest" }), [selected, part]);
  // Decided once: a field must not move away from under the hand of who types into it.
  const [first] = useState(() => new Map(fields.map((field) => [field.path, field.given || field.path in changes])));
  const isGiven = (field: Field) => first.get(field.path) ?? true;
  const defaults = fields.filter((field) => !isGiven(field));
  return (
    <div ref={list}>
      <Sections fields={fields.filter(isGiven)} marked={marked} />
      {defaults.length > 0 && (
        <details>
          <summary>{defaults.length} more, not in the file: their defaults hold</summary>
          <Sections fields={defaults} marked={marked} />
        </details>
      )}
    </div>
  );
}

function Sections({ fields, marked }: { fields: Field[]; marked: (path: string) => boolean }) {
  const changes = useStore((state) => state.history.present);
  const faults = useStore((state) => state.faults);
  const fault = (path: string) => faultsText(faults.filter((each) => isAbout(each, path)));
  return sections(fields).map(([section, inside]) => (
    <fieldset key={section}>
      {section && <legend>{section}</legend>}
      {inside.map((field) => (
        <FieldRow key={field.path} field={field} change={changes[field.path]} fault={fault(field.path)} marked={marked(field.path)} />
      ))}
    </fieldset>
  ));
}

/** Fields by the section of the block that they belong to, in their order; those of the block itself come first. */
function sections(fields: Field[]): [string, Field[]][] {
  const found = new Map<string, Field[]>([["", []]]);
  for (const field of fields) found.set(field.section, [...(found.get(field.section) ?? []), field]);
  return [...found].filter(([, inside]) => inside.length);
}
