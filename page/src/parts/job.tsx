// A job's controls: run, progress, cancel, what went wrong, and whether its result is still about the present design.

import { useMemo } from "react";
import type { JobKind } from "../protocol/client";
import type { Settings } from "../protocol/messages";
import { JOBS, type Job, type Stale, isOpen, keyOf, staleness } from "../state/jobs";
import { useStore } from "../state/store";

interface JobProps {
  kind: JobKind;
  /** What is run, as in "Run the branches". */
  name: string;
  /** What would be asked now. */
  settings: Settings;
  /** How long it takes, and what it does. */
  note: string;
}

export function JobControls({ kind, name, settings, note }: JobProps) {
  const job = useStore((state) => state.jobs[kind]);
  const text = useStore((state) => state.text);
  const files = useStore((state) => state.files);
  const changes = useStore((state) => state.history.present);
  const design = useMemo(() => keyOf({ text, files, changes }), [text, files, changes]);
  const run = () => void JOBS.begin(kind, settings);
  const stale = job?.result ? staleness(job.result, design, settings) : null;
  if (job && isOpen(job)) return <Progress job={job} cancel={() => JOBS.cancel(kind)} />;
  return (
    <div className="job">
      <button type="button" onClick={run}>{job?.result ? `Run ${name} again` : `Run ${name}`}</button>
      {!job && <small>{note}</small>}
      <span role="status">{[job?.state.state === "cancelled" && "Cancelled.", job?.result && !stale && "The result below is about the present design."].filter(Boolean).join(" ")}</span>
      {stale && <p className="banner" role="status">{STALE[stale]}</p>}
      {job?.state.errors.map((fault, i) => <p key={i} className="banner bad" role="alert">{fault.text}</p>)}
    </div>
  );
}

const STALE: { [stale in NonNullable<Stale>]: string } = {
  design: "The result below is about an earlier design: run it again for the present one.",
  settings: "The result below is about other settings: run it again for these.",
};

function Progress({ job, cancel }: { job: Job; cancel: () => void }) {
  const { state, done, total, text, place } = job.state;
  const share = total ? `${Math.round((100 * done) / total)} %` : "";
  const words = job.lost ? "No connection to the server; trying again" : state === "waiting" && place ? `Waiting in the queue, place ${place}` : [text || "Beginning", share].filter(Boolean).join(", ");
  return (
    <div className="job">
      <progress aria-label="Progress" max={total || undefined} value={total ? done : undefined} />
      <span role="status">{words} …</span>
      <button type="button" onClick={cancel}>Cancel</button>
    </div>
  );
}
