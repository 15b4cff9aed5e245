// The tabs of the views, and the one on screen with its settings and the answers it was given.

import { type KeyboardEvent, useEffect, useRef } from "react";
import type { Settings } from "../protocol/messages";
import { setSettings, setView } from "../state/actions";
import { update, useStore } from "../state/store";
import { Guarded } from "./guarded";
import { VIEWS, viewNamed } from "./registry";
import { Summary } from "./summary";
import type { View } from "./view";

export function Panel() {
  const name = useStore((state) => state.view);
  const view = viewNamed(name);
  return (
    <main>
      <Tabs chosen={view.name} />
      <div role="tabpanel" id="panel" aria-labelledby={`tab-${view.name}`} className="panel">
        <Guarded key={view.name} reset={() => update((state) => ({ settings: { ...state.settings, [view.name]: {} } }))}>
          <Content view={view} />
        </Guarded>
        <Summary key={`summary ${view.name}`} view={view} />
      </div>
    </main>
  );
}

function Tabs({ chosen }: { chosen: string }) {
  const list = useRef<HTMLDivElement>(null);
  const wrong = useStore((state) => state.faults.length > 0);
  const pressed = (event: KeyboardEvent) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const at = VIEWS.findIndex((view) => view.name === chosen);
    const next = VIEWS[(at + step + VIEWS.length) % VIEWS.length];
    setView(next.name);
    list.current?.querySelector<HTMLElement>(`#tab-${next.name}`)?.focus();
  };
  return (
    <div className="tabs">
      <div ref={list} role="tablist" aria-label="Views" onKeyDown={pressed}>
        {VIEWS.map(({ name, title }) => (
          <button key={name} id={`tab-${name}`} type="button" role="tab" aria-selected={name === chosen} aria-controls="panel" tabIndex={name === chosen ? 0 : -1} onClick={() => setView(name)}>
            {title}
          </button>
        ))}
      </div>
      <small className="wrong" role="status">{wrong ? "the last sound design is shown" : ""}</small>
    </div>
  );
}

const NONE: Settings = {};

function Content({ view }: { view: View }) {
  const told = useStore((state) => state.told[view.name]);
  const refused = useStore((state) => state.refused[view.name]);
  const settings = useStore((state) => state.settings[view.name]) ?? NONE;
  const model = useStore((state) => state.model);
  const variants = useStore((state) => state.variants);
  const variantsTold = useStore((state) => state.variantsTold[view.name]);
  const Component = view.component;
  const others = view.compares ? variants.map(({ name }, i) => ({ name, told: variantsTold?.[i] })) : [];
  useEffect(drawn);
  return (
    <>
      {refused?.map((fault, i) => <p key={i} className="banner bad" role="alert">{fault.text}</p>)}
      {told && model ? (
        <Component told={told} variants={others} model={model} settings={settings} set={(changes) => setSettings(view.name, changes)} />
      ) : (
        !refused?.length && <p className="note" role="status">Working it out …</p>
      )}
    </>
  );
}

/** A mark in the browser's timeline for whoever measures from a key press to the picture. */
function drawn(): void {
  performance.mark("torsional-drawn");
}
