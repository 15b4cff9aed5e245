// Another absorber in the place of the model's: ready blocks, scaled to the engine.

import { useEffect, useId, useState } from "react";
import { answers } from "../protocol/client";
import { type Absorber, isRefused } from "../protocol/messages";
import { chooseValue } from "../state/actions";
import { current, designOf, useStore } from "../state/store";

/** Those of the server's start for this model; where it can, scaled as studies of absorbers scale them. */
function useAbsorbers(): Absorber[] {
  const shipped = useStore((state) => state.start?.absorbers);
  const text = useStore((state) => state.text);
  const [scaled, set] = useState<Absorber[]>([]);
  useEffect(() => {
    const abort = new AbortController();
    set([]);
    answers({ ...designOf(current()), changes: {} }, [{ view: "absorbers" }], abort.signal)
      .then(([answer]) => !isRefused(answer) && set((answer as { absorbers: Absorber[] }).absorbers))
      .catch(() => undefined); // the shipped ones serve as well
    return () => abort.abort();
  }, [text]);
  return scaled.length ? scaled : (shipped ?? []);
}

export function AbsorberChoice() {
  const id = useId();
  const found = useAbsorbers();
  const label = useStore((state) => state.model?.absorber?.label ?? "none");
  const change = useStore((state) => state.history.present.absorber);
  const chosen = found.findIndex(({ block }) => JSON.stringify(block) === JSON.stringify(change));
  const choose = (index: number) => chooseValue("absorber", index < 0 ? undefined : found[index].block);
  return (
    <div className="field absorber">
      <label htmlFor={id}>type</label>
      <select id={id} value={chosen} onChange={(event) => choose(Number(event.target.value))}>
        <option value={-1}>{change === undefined ? `as in the file (${label})` : "as in the file"}</option>
        {found.map((absorber, index) => <option key={absorber.name ?? absorber.label} value={index}>{absorber.label}</option>)}
      </select>
      <small>Another absorber comes with values of its own; undo brings the former one back.</small>
    </div>
  );
}
