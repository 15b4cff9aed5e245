// The model's name, the operating point, and what can be done with the design as a whole.

import { endRun, redo, setPoint, undo } from "../state/actions";
import { keepTheme } from "../state/keeping";
import { type Theme, isUnsaved, update, useStore } from "../state/store";
import { FileButtons } from "./files";
import { NumberInput } from "./number";

export function Header() {
  const name = useStore((state) => state.model?.name ?? state.name);
  const unsaved = useStore(isUnsaved);
  return (
    <header>
      <h1>{name || "Workbench"}{unsaved && <small> · changed</small>}</h1>
      <OperatingPoint />
      <nav aria-label="Design">
        <Steps />
        <FileButtons />
        <ThemeSwitch />
      </nav>
    </header>
  );
}

function OperatingPoint() {
  const model = useStore((state) => state.model);
  const point = useStore((state) => state.point);
  if (model === null) return null;
  const { speed, torque, idle } = model.operation;
  return (
    <div className="point" role="group" aria-label="Operating point">
      {model.gears.length > 0 && (
        <span>
          <label htmlFor="gear">Gear</label>
          <select id="gear" value={point.gear ?? model.gear} onChange={(event) => setPoint({ gear: event.target.value })}>
            {model.gears.map((gear, i) => <option key={gear} value={gear}>{model.ratios[i] === undefined ? gear : `${gear} (i = ${Number(model.ratios[i].toPrecision(4))})`}</option>)}
          </select>
        </span>
      )}
      <NumberInput label="Mean torque" quantity="torque" value={point.torque} otherwise={model.full_load ? "full load" : "default"} from={torque ? torque[1] : 100} range={torque} put={(value) => setPoint({ torque: value })} />
      <NumberInput label="Speed" quantity="speed" value={point.speed} otherwise="default" from={speed[0] > 0 ? speed[0] : idle} range={speed} put={(value) => setPoint({ speed: value })} />
    </div>
  );
}

function Steps() {
  const canUndo = useStore((state) => state.history.past.length > 0);
  const canRedo = useStore((state) => state.history.future.length > 0);
  return (
    <>
      <button type="button" disabled={!canUndo} onClick={undo} title="Ctrl+Z">Undo</button>
      <button type="button" disabled={!canRedo} onClick={redo} title="Ctrl+Shift+Z">Redo</button>
    </>
  );
}

const NEXT: { [theme in Theme]: Theme } = { system: "light", light: "dark", dark: "system" };

function ThemeSwitch() {
  const theme = useStore((state) => state.theme);
  const turn = () => {
    keepTheme(NEXT[theme]);
    update({ theme: NEXT[theme] });
  };
  return <button type="button" onClick={turn} title="Light, dark, or as the system has it">{{ system: "◐ System", light: "☀ Light", dark: "☾ Dark" }[theme]}</button>;
}

/** Whether keys belong to a text that is no value of the design, as the name of a variant. */
function isOtherText(target: EventTarget | null): boolean {
  return target instanceof Element && target.matches("input[type=text], textarea") && target.closest(".field") === null;
}

/** Ctrl+Z and Ctrl+Shift+Z (or Ctrl+Y) on the page: a design has one history, whichever of its fields has the focus. */
export function listenForKeys(): () => void {
  const pressed = (event: KeyboardEvent) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isOtherText(event.target)) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    endRun();
    if (key === "y" || event.shiftKey) redo();
    else undo();
  };
  document.addEventListener("keydown", pressed);
  return () => document.removeEventListener("keydown", pressed);
}
