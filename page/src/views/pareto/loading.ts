// Fronts are fetched once, when they are first looked at.

import { useEffect, useState } from "react";
import { front as fetched } from "../../protocol/client";
import type { Front } from "./designs";

const kept = new Map<number, Front>();

export interface Loaded {
  front: Front | null;
  problem: string;
}

export function useFront(index: number): Loaded {
  const [loaded, set] = useState<Loaded & { index: number }>({ index, front: kept.get(index) ?? null, problem: "" });
  useEffect(() => {
    let isWanted = true;
    const put = (front: Front | null, problem = "") => isWanted && set({ index, front, problem });
    put(kept.get(index) ?? null);
    if (!kept.has(index)) {
      fetched(index)
        .then((found) => {
          kept.set(index, found as Front);
          put(found as Front);
        })
        .catch((problem: unknown) => put(null, problem instanceof Error ? problem.message : String(problem)));
    }
    return () => void (isWanted = false);
  }, [index]);
  return loaded.index === index ? loaded : { front: null, problem: "" };
}
