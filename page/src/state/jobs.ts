// Work in the background: begun, followed until it ends, cancelled, and found again after a reload.

import { type JobKind, Refused, Unreachable, beginJob, cancelJob, jobResult, jobState } from "../protocol/client";
import type { Design, Fault, JobState, Settings } from "../protocol/messages";
import { current, designOf, update } from "./store";

/** What was asked: of which design, under which settings. */
interface Asked {
  /** The server's name for it; empty before it has one. */
  id: string;
  /** Tells the design that it is about from others. */
  design: string;
  settings: Settings;
}

/** What a job came to; it stays on screen until the next one of its kind has come to something. */
export interface Result extends Asked {
  content: object;
}

export interface Job extends Asked {
  kind: JobKind;
  state: JobState;
  result: Result | null;
  /** Whether the server could not be reached when it was last asked. */
  lost: boolean;
}

/** How jobs reach the server; another one in tests. */
export interface Server {
  begin: typeof beginJob;
  state: typeof jobState;
  result: typeof jobResult;
  cancel: typeof cancelJob;
}

const SERVER: Server = { begin: beginJob, state: jobState, result: jobResult, cancel: cancelJob };
const WAITING: JobState = { state: "waiting", done: 0, total: 0, text: "", errors: [], place: null };
const EACH = 300;
const LONGEST = 4000;
const KEPT = "torsional.jobs";

export function isOpen(job: Job | undefined): boolean {
  return job?.state.state === "waiting" || job?.state.state === "running";
}

/** A short word for a design's content, by which another one is told from it (FNV-1a, twice, with two seeds). */
export function keyOf(design: Design): string {
  const text = JSON.stringify([design.text, Object.entries(design.files).sort(), Object.entries(design.changes)]);
  const hash = (seed: number) => {
    let value = seed;
    for (let i = 0; i < text.length; i++) value = Math.imul(value ^ text.charCodeAt(i), 0x01000193);
    return (value >>> 0).toString(16);
  };
  return `${hash(0x811c9dc5)}-${hash(0x1b873593)}-${text.length}`;
}

export type Stale = "design" | "settings" | null;

/** What of a result is no longer as it would be asked now. */
export function staleness(job: Asked, design: string, settings: Settings): Stale {
  if (job.design !== design) return "design";
  return sorted(job.settings) === sorted(settings) ? null : "settings";
}

function sorted(settings: Settings): string {
  return JSON.stringify(Object.entries(settings).sort());
}

export class Jobs {
  constructor(
    private readonly server: Server = SERVER,
    private readonly wait: (milliseconds: number) => Promise<void> = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds)),
  ) {}

  /** Begins a job about the present design in the place of the last one of its kind. */
  async begin(kind: JobKind, settings: Settings): Promise<void> {
    this.cancel(kind);
    const design = designOf(current());
    const result = current().jobs[kind]?.result ?? null;
    const job: Job = { kind, id: "", design: keyOf(design), settings, state: WAITING, result, lost: false };
    put(job);
    try {
      const id = await this.server.begin(design, kind, settings);
      // Cancelled, or begun anew, before the server had answered.
      if (current().jobs[kind] !== job) return void this.server.cancel(id).catch(() => undefined);
      put({ ...job, id });
      await this.follow(kind, id);
    } catch (problem) {
      if (current().jobs[kind] === job) put({ ...job, state: failed(problem) });
    }
  }

  /** Told at once; the server stops it when it hears of it, and by itself if it never does. */
  cancel(kind: JobKind): void {
    const job = current().jobs[kind];
    if (!job || !isOpen(job)) return;
    put({ ...job, state: { ...job.state, state: "cancelled" }, lost: false });
    if (job.id) void this.server.cancel(job.id).catch(() => undefined);
  }

  /** Asks how a job stands until it has ended or another one has taken its place. */
  async follow(kind: JobKind, id: string): Promise<void> {
    const present = () => {
      const job = current().jobs[kind];
      return job && job.id === id && job.state.state !== "cancelled" ? job : null;
    };
    for (let pause = EACH; present() !== null; await this.wait(pause)) {
      try {
        const state = await this.server.state(id);
        const content = state.state === "done" ? ((await this.server.result(id)) as object) : null;
        const job = present();
        if (job === null) return;
        const { design, settings } = job;
        put({ ...job, state, result: content ? { id, design, settings, content } : job.result, lost: false });
        if (!isOpen(current().jobs[kind])) return;
        pause = EACH;
      } catch (problem) {
        const job = present();
        if (job === null) return;
        if (isForgotten(problem) && job.state === WAITING) return drop(kind);
        if (!(problem instanceof Unreachable)) return put({ ...job, state: failed(problem) });
        put({ ...job, lost: true });
        pause = Math.min(LONGEST, 2 * pause);
      }
    }
  }

  /** Those that this tab had at work, or finished, before it was loaded anew. */
  resume(): void {
    for (const job of kept()) {
      put({ ...job, state: WAITING, result: null, lost: false });
      void this.follow(job.kind, job.id);
    }
  }
}

/** The server has restarted, or the job has been done for long. */
function isForgotten(problem: unknown): boolean {
  return problem instanceof Refused && problem.status === 404;
}

function drop(kind: JobKind): void {
  update((state) => ({ jobs: { ...state.jobs, [kind]: undefined } }));
  remember();
}

function put(job: Job): void {
  update((state) => ({ jobs: { ...state.jobs, [job.kind]: job } }));
  remember();
}

function failed(problem: unknown): JobState {
  const text = problem instanceof Error ? problem.message : String(problem);
  const unnamed: Fault = { where: "", problem: text, found: "", allowed: "", remedy: "", text };
  const errors = problem instanceof Refused && problem.faults.length ? problem.faults : [unnamed];
  return { ...WAITING, state: "failed", errors };
}

type Kept = Asked & Pick<Job, "kind">;

function remember(): void {
  const kept: Kept[] = Object.values(current().jobs).flatMap((job) => {
    const asked = job && (isOpen(job) ? job : job.result);
    return asked?.id ? [{ kind: job.kind, id: asked.id, design: asked.design, settings: asked.settings }] : [];
  });
  try {
    sessionStorage.setItem(KEPT, JSON.stringify(kept));
  } catch {
    // A reload then forgets them; nothing else is lost.
  }
}

function kept(): Kept[] {
  try {
    const found: unknown = JSON.parse(sessionStorage.getItem(KEPT) ?? "[]");
    return Array.isArray(found) ? (found as Kept[]).filter((job) => job?.kind && job.id && job.settings) : [];
  } catch {
    return [];
  }
}

export const JOBS = new Jobs();
