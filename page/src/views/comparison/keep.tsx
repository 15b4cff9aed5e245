// Keeping the present design as a variant, under a name.

import { useState } from "react";
import { useStore } from "../../state/store";
import { MOST_VARIANTS, gist, keepVariant } from "../../state/variants";

export function Keep() {
  const count = useStore((state) => state.variants.length);
  const usual = useStore((state) => gist(state.history.present));
  const [name, setName] = useState("");
  const keep = () => keepVariant(name.trim() || usual) && setName("");
  const isFull = count >= MOST_VARIANTS;
  return (
    <form className="settings keep" onSubmit={(event) => { event.preventDefault(); keep(); }}>
      <label className="choose">
        <span>Keep the present design as</span>
        <input type="text" maxLength={60} autoComplete="off" value={name} placeholder={usual} disabled={isFull} onChange={(event) => setName(event.target.value)} />
      </label>
      <button type="submit" disabled={isFull}>Keep as variant</button>
      <small>{isFull ? "Four designs are compared at most: remove one to keep another." : count === 0 ? "Then turn the knobs: the present design is compared with what you kept." : ""}</small>
    </form>
  );
}
