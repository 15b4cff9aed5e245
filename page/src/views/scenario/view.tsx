// Runs in time: an engine start, a shift, a clutch that closes; begun here, and played when they are done.

import { useState } from "react";
import { JobControls } from "../../parts/job";
import type { Settings } from "../../protocol/messages";
import { useStore } from "../../state/store";
import { Choose } from "../settings";
import type { Shown, View } from "../view";
import { type Run, valuesOf } from "./figures";
import { Player } from "./player";

function ScenarioView({ model, settings, set }: Shown) {
  const scenarios = useStore((state) => state.start?.scenarios ?? []);
  const result = useStore((state) => state.jobs.scenario?.result?.content) as Run | undefined;
  const chosen = scenarios.find(({ name }) => name === settings.scenario)?.name ?? scenarios[0]?.name ?? "";
  const text = typeof settings.values === "string" ? settings.values : "";
  const [values, problem] = read(text);
  const gear = model.gears.find((name) => name === settings.gear) ?? "";
  const asked: Settings = { scenario: chosen, ...(gear ? { gear } : {}), ...(Object.keys(values).length ? { values } : {}) };
  const title = scenarios.find(({ name }) => name === chosen)?.title ?? chosen;
  return (
    <>
      <div className="settings" role="group" aria-label="Settings of the scenario">
        <Choose label="Scenario" options={scenarios.map(({ name, title: words }) => [name, words ?? name])} value={chosen} put={(scenario) => set({ scenario, values: null })} />
        {model.gears.length > 0 && <Choose label="Gear" options={[["", "the scenario's own"], ...model.gears.map((name): [string, string] => [name, name])]} value={gear} put={(name) => set({ gear: name || null })} />}
      </div>
      <Values key={chosen} text={text} problem={problem} put={(next) => set({ values: next || null })} />
      {problem ? null : <JobControls kind="scenario" name={title.toLowerCase()} settings={asked} note="A run in time of the nonlinear machine: from some seconds to a few minutes." />}
      {result && <Player run={result} />}
    </>
  );
}

function read(text: string): [Settings, string] {
  try {
    return [valuesOf(text), ""];
  } catch (problem) {
    return [{}, problem instanceof Error ? problem.message : String(problem)];
  }
}

function Values({ text, problem, put }: { text: string; problem: string; put: (text: string) => void }) {
  const [draft, setDraft] = useState(text);
  return (
    <details className="values" open={text !== ""}>
      <summary>Its values, as in a scenario file</summary>
      <textarea rows={4} spellCheck={false} aria-label="Values of the scenario, a line of key: value each" aria-invalid={problem !== ""} placeholder={"duration: 3 s"} value={draft} onChange={(event) => setDraft(event.target.value)} onBlur={() => put(draft.trim())} />
      {problem && <p className="fault" role="alert">{problem}</p>}
    </details>
  );
}

export const SCENARIOS: View = { name: "scenarios", title: "Scenarios", asks: () => [], compares: false, component: ScenarioView };
