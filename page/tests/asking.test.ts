import { describe, expect, it } from "vitest";
import { Refused, Unreachable } from "../src/protocol/client";
import type { Answer, Design } from "../src/protocol/messages";
import { Asking, type Wanted } from "../src/state/asking";

const design = (value: string): Design => ({ text: "t", files: FILES, changes: { a: value } });
const FILES = {};
const wanted = (value: string, label = "modes"): Wanted => ({ design: design(value), asks: [{ view: label }], label });

/** A server that answers when told to, and what came of it. */
function staged() {
  const sent: { value: unknown; answer: (found: Answer<object>[]) => void; fail: (problem: Error) => void }[] = [];
  const log: string[] = [];
  const pauses: number[] = [];
  const post = (asked: Design, _: unknown, signal: AbortSignal) =>
    new Promise<Answer<object>[]>((answer, fail) => {
      signal.addEventListener("abort", () => fail(new DOMException("aborted", "AbortError")));
      sent.push({ value: asked.changes.a, answer, fail });
    });
  const asking = new Asking(
    post,
    {
      answered: (done) => log.push(`answered ${done.design.changes.a}`),
      refused: (_, faults) => log.push(`refused ${faults[0].text}`),
      connection: (state) => log.push(state),
    },
    (milliseconds) => Promise.resolve(void pauses.push(milliseconds)),
  );
  return { asking, sent, log, pauses, settled: () => new Promise((done) => setTimeout(done, 0)) };
}

describe("asking", () => {
  it("sends the newest of what was wanted while a request was under way", async () => {
    const { asking, sent, log, settled } = staged();
    for (const value of ["1", "2", "3"]) asking.want(wanted(value));
    expect(sent.map((request) => request.value)).toEqual(["1"]);
    sent[0].answer([]);
    await settled();
    sent[1].answer([]);
    await settled();
    expect(sent.map((request) => request.value)).toEqual(["1", "3"]);
    expect(log).toEqual(["good", "answered 1", "good", "answered 3"]);
  });

  it("gives up a request for another view", async () => {
    const { asking, sent, log, settled } = staged();
    asking.want(wanted("1", "map"));
    asking.want(wanted("1", "modes"));
    await settled();
    expect(sent).toHaveLength(2);
    sent[1].answer([]);
    await settled();
    expect(log).toEqual(["good", "answered 1"]);
  });

  it("asks nothing twice", async () => {
    const { asking, sent, settled } = staged();
    asking.want(wanted("1"));
    sent[0].answer([]);
    await settled();
    asking.want(wanted("1"));
    expect(sent).toHaveLength(1);
  });

  it("asks again what was forgotten", async () => {
    const { asking, sent, settled } = staged();
    asking.want(wanted("1"));
    sent[0].answer([]);
    await settled();
    asking.forget();
    asking.want(wanted("1"));
    expect(sent).toHaveLength(2);
  });

  it("tries again with growing pauses while the server is away, then with the newest wish", async () => {
    const { asking, sent, log, pauses, settled } = staged();
    asking.want(wanted("1"));
    for (let i = 0; i < 3; i++) {
      sent[i].fail(new Unreachable());
      await settled();
    }
    asking.want(wanted("2"));
    sent[3].fail(new Unreachable());
    await settled();
    sent[4].answer([]);
    await settled();
    expect(sent.map((request) => request.value)).toEqual(["1", "1", "1", "1", "2"]);
    expect(pauses).toEqual([500, 1000, 2000, 4000]);
    expect(log.slice(-2)).toEqual(["good", "answered 2"]);
  });

  it("hands refusals on and does not repeat them", async () => {
    const { asking, sent, log, settled } = staged();
    asking.want(wanted("x"));
    const fault = { where: "a", problem: "p", found: "f", allowed: "", remedy: "", text: "wrong" };
    sent[0].fail(new Refused(422, [fault]));
    await settled();
    expect(log).toEqual(["good", "refused wrong"]);
    expect(sent).toHaveLength(1);
  });

  it("waits for a busy server", async () => {
    const { asking, sent, log, settled } = staged();
    asking.want(wanted("1"));
    sent[0].fail(new Refused(429, []));
    await settled();
    sent[1].answer([]);
    await settled();
    expect(log).toEqual(["busy", "good", "answered 1"]);
  });
});
