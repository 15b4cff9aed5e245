import { beforeEach, describe, expect, it } from "vitest";
import { Refused, Unreachable } from "../src/protocol/client";
import type { Design, JobState } from "../src/protocol/messages";
import { begun } from "../src/state/history";
import { Jobs, type Server, keyOf, staleness } from "../src/state/jobs";
import { current, designOf, update } from "../src/state/store";

const STATE: JobState = { state: "running", done: 1, total: 4, text: "following", errors: [], place: 0 };
const settled = () => new Promise((done) => setTimeout(done, 0));

/** A server that tells what it is given, one after the other, and a clock that stands still between. */
function staged(...told: (Partial<JobState> | Error)[]) {
  const cancelled: string[] = [];
  const pauses: number[] = [];
  let begun = 0;
  let go: () => void = () => undefined;
  const server: Server = {
    begin: () => Promise.resolve(`job${++begun}`),
    state: () => {
      const next = told.shift();
      return next instanceof Error ? Promise.reject(next) : Promise.resolve({ ...STATE, ...next });
    },
    result: (id) => Promise.resolve({ of: id }),
    cancel: (id) => Promise.resolve(void cancelled.push(id)),
  };
  const wait = (milliseconds: number) => new Promise<void>((done) => void (pauses.push(milliseconds), (go = done)));
  const step = async () => {
    go();
    await settled();
  };
  return { jobs: new Jobs(server, wait), server, cancelled, pauses, step };
}

const branches = () => current().jobs.branches;

describe("jobs", () => {
  beforeEach(() => update({ text: "t", files: {}, history: begun({ a: "1" }), jobs: {} }));

  it("follows a job until its result is there", async () => {
    const { jobs, step } = staged({ state: "waiting", place: 2 }, {}, { state: "done" });
    void jobs.begin("branches", { gear: "12" });
    await settled();
    expect(branches()?.state).toMatchObject({ state: "waiting", place: 2 });
    await step();
    expect([branches()?.state.done, branches()?.result]).toEqual([1, null]);
    await step();
    expect(branches()?.result?.content).toEqual({ of: "job1" });
  });

  it("tells at once that a job is cancelled, whatever the server says after that", async () => {
    const { jobs, cancelled, step } = staged({}, {}, {});
    void jobs.begin("branches", {});
    await settled();
    jobs.cancel("branches");
    expect(branches()?.state.state).toBe("cancelled");
    await step();
    expect([branches()?.state.state, cancelled]).toEqual(["cancelled", ["job1"]]);
  });

  it("cancels one that the server names after it was given up", async () => {
    const { jobs, cancelled } = staged();
    void jobs.begin("branches", {});
    jobs.cancel("branches");
    await settled();
    expect([branches()?.state.state, cancelled]).toEqual(["cancelled", ["job1"]]);
  });

  it("lets a new job take the place of one that is at work", async () => {
    const { jobs, cancelled, step } = staged({}, { state: "done" });
    void jobs.begin("branches", {});
    await settled();
    void jobs.begin("branches", { gear: "1" });
    await settled();
    await step();
    expect([branches()?.id, branches()?.result?.content, cancelled]).toEqual(["job2", { of: "job2" }, ["job1"]]);
  });

  it("keeps the last result, with what it is about, until another one is there", async () => {
    const { jobs } = staged({ state: "done" }, { state: "failed" });
    await jobs.begin("branches", { gear: "12" });
    await jobs.begin("branches", { gear: "1" });
    expect(branches()).toMatchObject({ id: "job2", state: { state: "failed" }, result: { id: "job1", settings: { gear: "12" } } });
  });

  it("waits longer and longer for a server that is away, and goes on", async () => {
    const { jobs, pauses, step } = staged(new Unreachable(), new Unreachable(), { state: "done" });
    void jobs.begin("branches", {});
    await settled();
    expect(branches()?.lost).toBe(true);
    await step();
    await step();
    expect([pauses, branches()?.lost, branches()?.state.state]).toEqual([[600, 1200], false, "done"]);
  });

  it("hands on why a job was refused or failed", async () => {
    const fault = { where: "", problem: "too many", found: "", allowed: "", remedy: "", text: "too many jobs" };
    const { jobs, server } = staged({ state: "failed", errors: [fault] });
    await jobs.begin("branches", {});
    expect(branches()?.state.errors).toEqual([fault]);
    server.begin = () => Promise.reject(new Refused(429, [fault]));
    await jobs.begin("region", {});
    expect(current().jobs.region?.state).toMatchObject({ state: "failed", errors: [fault] });
  });

  it("knows what a result is no longer about", async () => {
    const { jobs } = staged({ state: "done" });
    await jobs.begin("branches", { gear: "12", torque: 1200 });
    const stale = (settings: Record<string, number | string>) => staleness(branches()!.result!, keyOf(designOf(current())), settings);
    expect(stale({ torque: 1200, gear: "12" })).toBeNull();
    expect(stale({ torque: 1300, gear: "12" })).toBe("settings");
    update({ history: begun({ a: "2" }) });
    expect(stale({ torque: 1200, gear: "12" })).toBe("design");
  });

  it("tells designs apart by text, files and the order of changes", () => {
    const designs: Design[] = [
      { text: "t", files: {}, changes: {} },
      { text: "u", files: {}, changes: {} },
      { text: "t", files: { a: "1" }, changes: {} },
      { text: "t", files: {}, changes: { a: 1, b: 2 } },
      { text: "t", files: {}, changes: { b: 2, a: 1 } },
    ];
    expect(new Set(designs.map(keyOf)).size).toBe(designs.length);
    expect(keyOf({ text: "t", files: { b: "", a: "" }, changes: {} })).toBe(keyOf({ text: "t", files: { a: "", b: "" }, changes: {} }));
  });
});
