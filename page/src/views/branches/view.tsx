// Periodic motion of the nonlinear machine: branches over speed, and the region of half the engine's order.

import { JobControls } from "../../parts/job";
import { NumberInput } from "../../parts/number";
import type { ModelAnswer, Settings } from "../../protocol/messages";
import { type Point, useStore } from "../../state/store";
import { Choose } from "../settings";
import { words } from "../values";
import type { Shown, View } from "../view";
import { BranchPicture } from "./picture";
import type { Branches } from "./figures";
import { type Region, RegionPicture } from "./region";

function gearOf(settings: Settings, point: Point, model: ModelAnswer): string {
  const chosen = String(settings.gear ?? point.gear ?? model.gear);
  return model.gears.includes(chosen) ? chosen : model.gear;
}

/** What a job is begun with: the view's own settings, else the operating point. */
function branchSettings(settings: Settings, point: Point, model: ModelAnswer): Settings {
  const torque = typeof settings.torque === "number" ? settings.torque : (point.torque ?? "full_load");
  const known = [...model.elements, ...model.nodes];
  const asked: Settings = { gear: gearOf(settings, point, model), torque };
  if (typeof settings.place === "string" && known.includes(settings.place)) asked.place = settings.place;
  if (settings.isolated === true) asked.isolated = true;
  return asked;
}

function BranchView({ model, settings, set }: Shown) {
  const point = useStore((state) => state.point);
  const branches = useStore((state) => state.jobs.branches?.result?.content) as Branches | undefined;
  const region = useStore((state) => state.jobs.region?.result?.content) as Region | undefined;
  const show = (shown: string) => set({ shown });
  return (
    <>
      <h2 className="hidden">Branches of periodic motion</h2>
      <BranchSettings model={model} settings={settings} set={set} point={point} />
      <JobControls kind="branches" name="branches" settings={branchSettings(settings, point, model)} note="Follows every periodic motion over speed, stable and unstable; some seconds to a minute." />
      {branches && <BranchPicture found={branches} shown={String(settings.shown ?? "")} show={show} />}
      <JobControls kind="region" name="the region of half the engine's order" settings={{ gear: gearOf(settings, point, model) }} note="Over speed and mean torque: where ignitions two by two shake the line; up to a minute." />
      {region && <RegionPicture found={region} />}
    </>
  );
}

interface SettingsProps {
  model: ModelAnswer;
  settings: Settings;
  set: (settings: Settings) => void;
  point: Point;
}

function BranchSettings({ model, settings, set, point }: SettingsProps) {
  const { torque } = model.operation;
  const places = [...model.elements, ...model.nodes].map((name): [string, string] => [name, words(name)]);
  const usual = point.torque === null ? "full load" : "as above";
  return (
    <div className="settings" role="group" aria-label="Settings of the branches">
      {model.gears.length > 0 && <Choose label="Gear" options={model.gears.map((gear) => [gear, gear])} value={gearOf(settings, point, model)} put={(gear) => set({ gear })} />}
      <NumberInput label="Mean torque of the branches" quantity="torque" value={typeof settings.torque === "number" ? settings.torque : null} otherwise={usual} from={point.torque ?? torque?.[1] ?? 100} put={(value) => set({ torque: value })} />
      <Choose label="Seen at" options={[["", "the absorber's spring"], ...places]} value={String(settings.place ?? "")} put={(place) => set({ place: place || null })} />
      <label className="check">
        <input type="checkbox" checked={settings.isolated === true} onChange={(event) => set({ isolated: event.target.checked })} /> search for isolated branches too
      </label>
    </div>
  );
}

export const BRANCHES: View = { name: "branches", title: "Branches", asks: () => [], compares: false, component: BranchView };
