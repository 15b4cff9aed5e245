// What the user should know at once: a lost connection, what is wrong with the design, what was done.

import type { Fault, FieldGroup } from "../protocol/messages";
import { select, tell, undo } from "../state/actions";
import { type State, update, useStore } from "../state/store";
import { takeWork } from "../state/keeping";
import { groupOf } from "./fields";
import { isAbout } from "./limits";

export function Notices() {
  const connection = useStore((state) => state.connection);
  const notice = useStore((state) => state.notice);
  const faults = useStore((state) => state.faults);
  const aside = useStore((state) => state.aside);
  return (
    <>
      {connection === "lost" && <p className="banner bad" role="alert">No connection to the server: your work is safe here, and goes on as soon as it answers again.</p>}
      {connection === "busy" && <p className="banner" role="status">The server is busy; trying again.</p>}
      {faults.length > 0 && <Faults faults={faults} />}
      {aside && (
        <p className="banner" role="status">
          The changes of {aside.name} were not saved. <button type="button" onClick={() => takeWork(aside)}>Bring them back</button>{" "}
          <button type="button" onClick={() => update({ aside: null })} aria-label="Let the changes go">×</button>
        </p>
      )}
      {notice && (
        <p className="banner" role="status">
          {notice} <button type="button" onClick={() => tell("")} aria-label="Close the notice">×</button>
        </p>
      )}
    </>
  );
}

/** Faults of fields in sight are told there; the others here, with the way to their fields. */
function Faults({ faults }: { faults: Fault[] }) {
  const shown = useStore(fieldsInSight);
  const canUndo = useStore((state) => state.history.past.length > 0);
  const elsewhere = faults.filter((fault) => !shown.some((path) => isAbout(fault, path)));
  if (!elsewhere.length) return null;
  return (
    <div className="banner bad" role="alert">
      <ul>
        {elsewhere.slice(0, 6).map((fault, i) => (
          <li key={i}>
            {fault.text} {fault.where && <button type="button" onClick={() => select(fault.where)}>Show the field</button>}
          </li>
        ))}
      </ul>
      {canUndo && <button type="button" onClick={undo}>Undo the change</button>}
    </div>
  );
}

const NONE: string[] = [];
let seen: { group: FieldGroup; paths: string[] } | undefined;

/** Key paths of the values on screen; the same array as long as they are the same. */
function fieldsInSight({ model, selected }: State): string[] {
  const group = model && groupOf(model.groups, selected);
  if (!group) return NONE;
  if (seen?.group !== group) seen = { group, paths: group.fields.map((field) => field.path) };
  return seen.paths;
}

export function Warnings() {
  const warnings = useStore((state) => state.model?.warnings);
  if (!warnings?.length) return null;
  return (
    <details className="warnings">
      <summary>{warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`}</summary>
      <ul>{warnings.map((text) => <li key={text}>{text}</li>)}</ul>
    </details>
  );
}
