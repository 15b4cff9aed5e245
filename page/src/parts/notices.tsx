// What the user should know at once: a lost connection, what is wrong with the design, what was done.

import type { Fault } from "../protocol/messages";
import { tell, undo } from "../state/actions";
import { update, useStore } from "../state/store";

export function Notices() {
  const connection = useStore((state) => state.connection);
  const notice = useStore((state) => state.notice);
  const faults = useStore((state) => state.faults);
  return (
    <>
      {connection === "lost" && <p className="banner bad" role="alert">No connection to the server: your work is safe here, and goes on as soon as it answers again.</p>}
      {connection === "busy" && <p className="banner" role="status">The server is busy; trying again.</p>}
      {faults.length > 0 && <Faults faults={faults} />}
      {notice && (
        <p className="banner" role="status">
          {notice} <button type="button" onClick={() => tell("")} aria-label="Close the notice">×</button>
        </p>
      )}
    </>
  );
}

function Faults({ faults }: { faults: Fault[] }) {
  const canUndo = useStore((state) => state.history.past.length > 0);
  return (
    <div className="banner bad" role="alert">
      <ul>
        {faults.slice(0, 6).map((fault, i) => (
          <li key={i}>
            {fault.text} {fault.where && <button type="button" onClick={() => update({ selected: fault.where })}>Show the field</button>}
          </li>
        ))}
      </ul>
      <p>The pictures show the last design that was sound. {canUndo && <button type="button" onClick={undo}>Undo the change</button>}</p>
    </div>
  );
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
