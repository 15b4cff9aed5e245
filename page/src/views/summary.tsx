// What changed in the pictures, read out once the hand has come to rest.

import { useEffect, useState } from "react";
import { useStore } from "../state/store";
import type { View } from "./view";

const REST = 900;

export function Summary({ view }: { view: View }) {
  const told = useStore((state) => state.told[view.name]);
  const units = useStore((state) => state.start?.units);
  const [text, setText] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => setText(told && units && view.summary ? view.summary(told, units) : ""), REST);
    return () => clearTimeout(timer);
  }, [told, units, view]);
  return <p className="hidden" role="status" aria-live="polite">{text}</p>;
}
