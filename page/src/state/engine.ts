// Asks the server whatever the design, the operating point and the view on screen need, and keeps the answers.

import { answers as post } from "../protocol/client";
import { type Answer, type Ask, type Changes, type Design, type Fault, type ModelAnswer, isRefused } from "../protocol/messages";
import { gearOf } from "../views/point";
import { viewNamed } from "../views/registry";
import { Asking, type Listener, type Wanted } from "./asking";
import { type State, current, designOf, subscribe, update } from "./store";
import { MOST_VARIANTS } from "./variants";

const MODEL = "model";

function viewAsks(state: State): Ask[] {
  const view = viewNamed(state.view);
  return view.asks({ model: state.model, point: state.point, settings: state.settings[view.name] ?? {} });
}

function modelAsk(state: State): Ask {
  return { view: MODEL, ...gearOf(state.point) };
}

/** The design told without its changes: shown where the changes are wrong from the beginning. */
function withoutChanges(design: Design): Design {
  return { ...design, changes: {} };
}

const asker = new Asking(post, { answered, refused, connection });
const fallback = new Asking(post, { answered: fallbackAnswered, refused, connection });
const variantAskers = Array.from({ length: MOST_VARIANTS }, (_, index) => new Asking(post, variantListener(index)));

function connection(connection: State["connection"]): void {
  if (current().connection !== connection) update({ connection });
}

/** Whether an answer is about the file that is open, and not about one that it has taken the place of. */
function isCurrent(wanted: Wanted): boolean {
  const { text, files } = current();
  return wanted.design.text === text && wanted.design.files === files;
}

function answered(wanted: Wanted, found: Answer<object>[]): void {
  if (!isCurrent(wanted)) return;
  const [model, ...rest] = found;
  if (isRefused(model)) return refused(wanted, model.errors as Fault[]);
  clearTimeout(telling);
  const view = wanted.label;
  const faults = rest.flatMap((answer) => (isRefused(answer) ? (answer.errors as Fault[]) : []));
  update((state) => ({
    model: model as ModelAnswer,
    faults: [],
    told: faults.length ? state.told : { ...state.told, [view]: { asks: wanted.asks.slice(1), answers: rest } },
  }));
  // A model of other parts may make the view ask otherwise; what the old asks led to is then of no interest.
  const asks = viewAsks(current());
  const outdated = current().view === view && JSON.stringify(asks) !== JSON.stringify(wanted.asks.slice(1));
  if (!outdated) update((state) => ({ refused: { ...state.refused, [view]: faults } }));
}

const PATIENCE = 400;
let telling: ReturnType<typeof setTimeout> | undefined;

/** Told after a moment, since a value is wrong half the time while it is typed. */
function refused(wanted: Wanted, faults: Fault[]): void {
  if (!isCurrent(wanted)) return;
  clearTimeout(telling);
  telling = setTimeout(() => update({ faults }), current().model === null ? 0 : PATIENCE);
  if (current().model === null && Object.keys(wanted.design.changes).length) {
    fallback.want({ design: withoutChanges(wanted.design), asks: [{ view: MODEL }], label: MODEL });
  }
}

function fallbackAnswered(_: Wanted, [model]: Answer<object>[]): void {
  if (!isRefused(model) && current().model === null) update({ model: model as ModelAnswer });
}

function variantListener(index: number): Listener {
  const put = (wanted: Wanted, found: Answer<object>[]) => {
    if (current().variants[index]?.design !== wanted.design) return; // it has been moved or removed meanwhile
    update((state) => {
      const row = [...(state.variantsTold[wanted.label] ?? [])];
      row[index] = found.some(isRefused) ? undefined : { asks: wanted.asks, answers: found };
      return { variantsTold: { ...state.variantsTold, [wanted.label]: row } };
    });
  };
  return { answered: put, refused: (wanted) => put(wanted, [{ errors: [] }]), connection };
}

let askedVariants: State["variants"] = [];

/** What the parts of the drawing are made of changes with the kind of absorber and the gear, not with values. */
const partsAsker = new Asking(post, {
  answered: (_, [found]) => update({ parts: isRefused(found) ? {} : (found as { parts: State["parts"] }).parts }),
  refused: () => update({ parts: {} }),
  connection: () => undefined,
});

function askParts(state: State): void {
  if (!state.part) return;
  const { absorber } = state.history.present;
  const changes: Changes = absorber === undefined ? {} : { absorber };
  const gear = gearOf(state.point);
  partsAsker.want({ design: { ...designOf(state), changes }, asks: [{ view: "parts", ...gear }], label: "parts" });
}

function ask(): void {
  const state = current();
  if (state.variants !== askedVariants) variantAskers.forEach((asker) => asker.forget());
  askedVariants = state.variants;
  if (!state.text) return;
  const asks = viewAsks(state);
  asker.want({ design: designOf(state), asks: [modelAsk(state), ...asks], label: state.view });
  askParts(state);
  if (!viewNamed(state.view).compares || !asks.length) return;
  state.variants.forEach(({ design }, index) => variantAskers[index].want({ design, asks, label: state.view }));
}

export function beginAsking(): () => void {
  ask();
  return subscribe(ask);
}
