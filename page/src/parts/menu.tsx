// A button with a short list below it, closed by Escape, by a choice and by leaving it.

import { type FocusEvent, type KeyboardEvent, type ReactNode, useRef } from "react";

export function Menu({ label, children }: { label: string; children: ReactNode }) {
  const ref = useRef<HTMLDetailsElement>(null);
  const close = (back: boolean) => {
    if (!ref.current?.open) return;
    ref.current.open = false;
    if (back) ref.current.querySelector("summary")?.focus();
  };
  const pressed = (event: KeyboardEvent) => event.key === "Escape" && close(true);
  const left = (event: FocusEvent) => !ref.current?.contains(event.relatedTarget) && close(false);
  return (
    <details ref={ref} className="menu" onKeyDown={pressed} onBlur={left}>
      <summary>{label}</summary>
      <div onClick={(event) => (event.target as Element).closest("button") && close(true)}>{children}</div>
    </details>
  );
}
