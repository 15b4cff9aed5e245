// The present design and up to three that were kept, side by side: criteria, response, and what differs.

import type { Ask } from "../../protocol/messages";
import type { Settings } from "../../protocol/messages";
import { Choose } from "../settings";
import type { Context, Shown, View } from "../view";
import { Changed } from "./changed";
import type { Criterion } from "./figures";
import { Keep } from "./keep";
import { type Compared, QuietResponse } from "./response";
import { CriteriaTable } from "./table";

/** The figures, and the response of the main order at the places that matter. */
function asks({ model, point }: Context): Ask[] {
  const gear: Settings = point.gear === null ? {} : { gear: point.gear };
  const torque: Settings = point.torque === null ? {} : { torque: point.torque };
  const orders: Settings = model?.main_order ? { orders: [model.main_order] } : {};
  return [{ view: "criteria", ...gear }, { view: "response", ...gear, ...torque, ...orders }];
}

const PRESENT = "present";

function Comparison({ told, variants, model, settings, set }: Shown) {
  const [criteria, response] = told.answers as [{ gear: string; criteria: Criterion[] }, Compared];
  const names = [PRESENT, ...variants.map(({ name }) => name)];
  const found = [criteria.criteria, ...variants.map(({ told: other }) => (other ? (other.answers[0] as typeof criteria).criteria : null))];
  const reference = Math.min(Number(settings.reference ?? 0) || 0, names.length - 1);
  const others = variants.map(({ name, told: other }) => ({ name, response: other?.answers[1] as Compared | undefined }));
  return (
    <>
      <Keep />
      {variants.length > 0 && (
        <div className="settings">
          <Choose label="Differences to" options={names.map((name, i) => [String(i), name])} value={String(reference)} put={(index) => set({ reference: Number(index) })} />
        </div>
      )}
      <CriteriaTable names={names} criteria={found} reference={reference} gear={criteria.gear} ask={told.asks[0]} />
      <QuietResponse response={response} others={others} quiet={model.landmarks.input || model.landmarks.crankshaft} ask={told.asks[1]} />
      <Changed names={names} />
    </>
  );
}

export const COMPARISON: View = { name: "comparison", title: "Comparison", asks, compares: true, component: Comparison };
