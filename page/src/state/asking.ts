// One request at a time; what is wanted meanwhile waits, and only the newest of it is sent.

import { Refused, Unreachable } from "../protocol/client";
import type { Answer, Ask, Design, Fault } from "../protocol/messages";

export interface Wanted {
  design: Design;
  asks: Ask[];
  /** Told back with the answer. */
  label: string;
}

export interface Listener {
  answered(wanted: Wanted, answers: Answer<object>[]): void;
  refused(wanted: Wanted, faults: Fault[]): void;
  connection(state: "good" | "lost" | "busy"): void;
}

export type Post = (design: Design, asks: Ask[], signal: AbortSignal) => Promise<Answer<object>[]>;
export type Wait = (milliseconds: number) => Promise<void>;

const pause: Wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
const LONGEST_PAUSE = 5000;

export class Asking {
  private next: Wanted | null = null;
  private flight: { wanted: Wanted; abort: AbortController } | null = null;
  private last: Wanted | null = null;

  constructor(
    private readonly post: Post,
    private readonly listener: Listener,
    private readonly wait: Wait = pause,
  ) {}

  /** Ask this as soon as may be; nothing is sent for what was asked last. */
  want(wanted: Wanted): void {
    if (this.last !== null && same(this.last, wanted)) return;
    this.last = wanted;
    this.next = wanted;
    if (this.flight === null) void this.run();
    // Edits of one view wait for the answer under way, so that the picture moves while a key is held down; another
    // view's picture nobody waits for any more.
    else if (this.flight.wanted.label !== wanted.label) this.flight.abort.abort();
  }

  /** Ask again even what was asked last: its answer was thrown away. */
  forget(): void {
    this.last = null;
  }

  private async run(): Promise<void> {
    let failures = 0;
    while (this.next !== null) {
      const wanted = this.next;
      this.next = null;
      this.flight = { wanted, abort: new AbortController() };
      const outcome = await this.once(wanted, this.flight.abort.signal);
      failures = outcome === "again" ? failures + 1 : 0;
      if (outcome === "again") {
        this.next ??= wanted;
        await this.wait(Math.min(LONGEST_PAUSE, 250 * 2 ** Math.min(failures, 6)));
      }
    }
    this.flight = null;
  }

  private async once(wanted: Wanted, signal: AbortSignal): Promise<"done" | "again"> {
    try {
      const answers = await this.post(wanted.design, wanted.asks, signal);
      this.listener.connection("good");
      this.listener.answered(wanted, answers);
      return "done";
    } catch (problem) {
      return this.failed(wanted, problem, signal);
    }
  }

  private failed(wanted: Wanted, problem: unknown, signal: AbortSignal): "done" | "again" {
    if (signal.aborted) return "done";
    const busy = problem instanceof Refused && problem.status === 429;
    if (busy || problem instanceof Unreachable) {
      this.listener.connection(busy ? "busy" : "lost");
      return "again";
    }
    this.listener.connection("good");
    const text = problem instanceof Error ? problem.message : String(problem);
    const unnamed = { where: "", problem: text, found: "", allowed: "", remedy: "", text };
    this.listener.refused(wanted, problem instanceof Refused && problem.faults.length ? problem.faults : [unnamed]);
    return "done";
  }
}

function same(a: Wanted, b: Wanted): boolean {
  return (
    a.label === b.label &&
    a.design.text === b.design.text &&
    a.design.files === b.design.files &&
    JSON.stringify([a.design.changes, a.asks]) === JSON.stringify([b.design.changes, b.asks])
  );
}
