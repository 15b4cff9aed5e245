"""Bad input: one message each, with the file, the key path, what was found, what is allowed and what to do.

Every case is a shipped model or a small machine with one thing wrong.  The whole message after the file's name is
asserted, so that a change of words is seen; "(line ?)" stands for the line that was changed.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from tests.shipped import EXAMPLES

from torsional.errors import ModelError
from torsional.files import load_model

TRUCK = (EXAMPLES / "truck_dmf.yaml").read_text(encoding="utf-8")
CURVE = (EXAMPLES / "truck13_full_load.csv").read_text(encoding="utf-8")
LINE = """\
torsional: 1
name: line
components:
  engine: {type: inertia, inertia: 1.5}
  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}
  pinion: {type: inertia, inertia: 0.1}
  gear: {type: gear_pair, a: pinion, b: wheel, ratio: 2}
  wheel: {type: inertia, inertia: 3}
"""


def told(path: Path) -> str:
    """What loading says after the file's name: in one error, within a second of computing."""
    before = time.process_time()
    with pytest.raises(ModelError) as caught:
        load_model(path)
    assert time.process_time() - before < 1.0
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    return text.removeprefix(f"{path}: ")


def message(folder: Path, text: str | bytes, curve: str | bytes | None = CURVE) -> str:
    path = folder / "m.yaml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    if curve is not None:
        (folder / "truck13_full_load.csv").write_bytes(curve.encode() if isinstance(curve, str) else curve)
    return told(path)


def swapped(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1, old
    return text.replace(old, new)


def line_of(text: str, part: str) -> str:
    return f"(line {text[: text.index(part)].count(chr(10)) + 1})"


# --- one value of the truck replaced ---

VALUES = [
    ("primary_inertia: 1.2 kgm²", ".nan", "absorber.primary_inertia (line ?): a finite number is wanted; found nan"),
    ("primary_inertia: 1.2 kgm²", "-.inf", "absorber.primary_inertia (line ?): a finite number is wanted; found -inf"),
    ("primary_inertia: 1.2 kgm²", "1e999", "absorber.primary_inertia (line ?): a finite number is wanted; found inf"),
    (
        "primary_inertia: 1.2 kgm²",
        "heavy",
        ("absorber.primary_inertia (line ?): a number is wanted, with or without a unit after it; found 'heavy'"),
    ),
    (
        "primary_inertia: 1.2 kgm²",
        "true",
        (
            "absorber.primary_inertia (line ?): an inertia is wanted: a number, or a text such as '1.5 "
            "kgm²'; found True (bool)"
        ),
    ),
    (
        "primary_inertia: 1.2 kgm²",
        "no",
        ("absorber.primary_inertia (line ?): a number is wanted, with or without a unit after it; found 'no'"),
    ),
    (
        "primary_inertia: 1.2 kgm²",
        "[1, 2]",
        (
            "absorber.primary_inertia (line ?): an inertia is wanted: a number, or a text such as '1.5 "
            "kgm²'; found [1, 2] (list)"
        ),
    ),
    (
        "primary_inertia: 1.2 kgm²",
        "{kg: 1}",
        (
            "absorber.primary_inertia (line ?): an inertia is wanted: a number, or a text such as '1.5 "
            "kgm²'; found {'kg': 1} (dict)"
        ),
    ),
    (
        "primary_inertia: 1.2 kgm²",
        "0",
        "absorber.primary_inertia (line ?): must be positive; found 0; allowed: > 0 kgm²",
    ),
    (
        "secondary_inertia: 1.0 kgm²",
        "-1 kgm²",
        "absorber.secondary_inertia (line ?): must be positive; found '-1 kgm²'; allowed: > 0 kgm²",
    ),
    ("stiffness: 13 kNm/rad", "0", "absorber.stiffness (line ?): must be positive; found 0; allowed: > 0 Nm/rad"),
    (
        "stiffness: 13 kNm/rad",
        "-13e3",
        "absorber.stiffness (line ?): must be positive; found -13000; allowed: > 0 Nm/rad",
    ),
    (
        "stiffness: 13 kNm/rad",
        "13 kNm",
        (
            "absorber.stiffness (line ?): kNm is a torque, and a stiffness is wanted; found '13 kNm'; "
            "allowed: Nm/rad, Nm/deg, kNm/rad, kNm/deg, MNm/rad, MNm/deg"
        ),
    ),
    (
        "stiffness: 13 kNm/rad",
        "13 kNm/furlong",
        (
            "absorber.stiffness (line ?): the unit 'kNm/furlong' is unknown; found '13 kNm/furlong'; "
            "allowed: Nm/rad, Nm/deg, kNm/rad, kNm/deg, MNm/rad, MNm/deg"
        ),
    ),
    (
        "stiffness: 13 kNm/rad",
        "13,5 kNm/rad",
        (
            "absorber.stiffness (line ?): a comma is neither a decimal point nor a thousands separator here; "
            "write 1.5 or 1500; found '13,5 kNm/rad'"
        ),
    ),
    (
        "stiffness: 13 kNm/rad",
        "13_000",
        "absorber.stiffness (line ?): digits are not grouped by underscores; write 1500; found '13_000'",
    ),
    ("damping: 20", "-20", "absorber.damping (line ?): must not be negative; found -20; allowed: >= 0 Nm s/rad"),
    (
        "final_drive_ratio: 2.85",
        "0",
        "driveline.final_drive_ratio (line ?): must not be zero; found 0; allowed: any other number",
    ),
    ("rolling_radius: 0.5 m", "0 m", "vehicle.rolling_radius (line ?): must be positive; found '0 m'; allowed: > 0 m"),
    ("compression_ratio: 18.1", "1", "engine.compression_ratio (line ?): is too small; found 1; allowed: > 1"),
    (
        "compression_ratio: 18.1",
        "50",
        "engine.compression_ratio (line ?): is out of range; found 50; allowed: 2 to 40",
    ),
    (
        "idle: 600 rpm",
        "0x258",
        (
            "operation.idle (line ?): numbers are decimal; found '0x258'; write it in decimal, or in quotes "
            "if a text is meant"
        ),
    ),
    (
        "idle: 600 rpm",
        "12:30:00",
        "operation.idle (line ?): one number is wanted, not a clock time or a range; found '12:30:00'",
    ),
    (
        "speed: 600:2000 rpm",
        "2000:600 rpm",
        "operation.speed (line ?): a range must end above its start; found '2000:600 rpm'",
    ),
    (
        "speed: 600:2000 rpm",
        "600 rpm",
        (
            "operation.speed (line ?): a range is wanted; found '600 rpm'; allowed: '600:2000 rpm', "
            "'600:2000:20 rpm' or a list of two or three values"
        ),
    ),
    (
        "rod_length: 267.5 mm",
        "70 mm",
        (
            "engine.rod_length (line ?): the rod is too short for the crank to turn; found 0.07 m; allowed: "
            "more than crank radius plus pin offset, 0.079 m"
        ),
    ),
    (
        "firing_order: [1, 5, 3, 6, 2, 4]",
        "[1, 5, 3, 6, 2, 2]",
        (
            "engine.firing_order (line ?): the firing order must name every cylinder once; found 1, 5, 3, 6, "
            "2, 2; allowed: 1 to 6"
        ),
    ),
    (
        "firing_order: [1, 5, 3, 6, 2, 4]",
        "[5, 1, 3, 6, 2, 4]",
        (
            "engine.firing_order (line ?): the firing order must begin with 1; found 5, 1, 3, 6, 2, 4; turn "
            "the list until cylinder 1 leads: crank angles count from its firing top dead centre"
        ),
    ),
    (
        "firing_order: [1, 5, 3, 6, 2, 4]",
        "[1, 3, 4, 2]",
        (
            "engine.firing_order (line ?): the firing order does not fit the layout; found 4 cylinders; "
            "allowed: 6, as the layout says"
        ),
    ),
    (
        "firing_order: [1, 5, 3, 6, 2, 4]",
        "1-5-3-6-2-4",
        "engine.firing_order (line ?): a list is wanted; found '1-5-3-6-2-4'",
    ),
    (
        "layout: inline-6",
        "boxer-6",
        (
            "engine.layout (line ?): the layout is unknown; found 'boxer-6'; allowed: inline-1 to inline-16, "
            "vee-2 to vee-16"
        ),
    ),
    (
        "stop_torque: 3500 Nm",
        "",
        "absorber.stop_torque (line ?): the key has no value; give it one, or remove the line",
    ),
    (
        "throw_inertia: 0.11 kgm²",
        "[0.11, 0.11]",
        (
            "crankshaft.throw_inertia (line ?): the list has the wrong length; found 2 values; allowed: one "
            "value, or 6, one a throw"
        ),
    ),
    (
        "type: dual_mass_flywheel",
        "dual_mas_flywheel",
        (
            "absorber.type (line ?): there is no such type; found 'dual_mas_flywheel'; did you mean "
            "'dual_mass_flywheel'?"
        ),
    ),
    (
        "full_load: truck13_full_load.csv",
        "../truck13_full_load.csv",
        (
            "engine.full_load (line ?): '..' is not followed; found '../truck13_full_load.csv'; put the file "
            "beside the model file, or in a folder there"
        ),
    ),
    (
        "full_load: truck13_full_load.csv",
        "/etc/passwd",
        (
            "engine.full_load (line ?): an absolute path or a drive is not followed; found '/etc/passwd'; "
            "put the file beside the model file, or in a folder there"
        ),
    ),
    (
        "full_load: truck13_full_load.csv",
        "'C:\\secret.csv'",
        (
            "engine.full_load (line ?): an absolute path or a drive is not followed; found 'C:\\\\secret.csv'; "
            "put the file beside the model file, or in a folder there"
        ),
    ),
    (
        "full_load: truck13_full_load.csv",
        "truck13_fulload.csv",
        (
            "engine.full_load (line ?): there is no such file; found 'truck13_fulload.csv'; did you mean "
            "'truck13_full_load.csv'?"
        ),
    ),
    (
        "full_load: truck13_full_load.csv",
        ".",
        "engine.full_load (line ?): this is a folder, not a file; found '.'; name the file in it",
    ),
]


@pytest.mark.parametrize(("line", "value", "expected"), VALUES, ids=[f"{v[0].split(':')[0]}={v[1]}" for v in VALUES])
def test_value(tmp_path: Path, line: str, value: str, expected: str) -> None:
    key = line.partition(":")[0]
    text = swapped(TRUCK, f"  {line}", f"  {key}: {value}")
    assert message(tmp_path, text) == expected.replace("(line ?)", line_of(TRUCK, f"  {line}"))


# --- a small machine: one text replaced by another, or lines added at its end ---

MACHINE = [
    (
        "disconnected",
        "  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}\n",
        "",
        (
            "components (line 3): the nodes do not hang together; found 2 parts: {engine}; {pinion, wheel}; "
            "allowed: 1 part; connect them by a shaft, a coupling or gears"
        ),
    ),
    (
        "a lonely node",
        "",
        "  brake: {type: inertia, inertia: 1}\n",
        (
            "components (line 3): the nodes do not hang together; found 2 parts: {engine, pinion, wheel}; "
            "{brake}; allowed: 1 part; connect them by a shaft, a coupling or gears"
        ),
    ),
    (
        "duplicate names",
        "",
        "  shaft: {type: damper, a: wheel, damping: 1}\n",
        "components.shaft (line 9): the key stands twice; found it stands on line 5 already",
    ),
    (
        "a part name taken by another",
        "",
        "  ballast: {type: inertia, inertia: 1, node: gruond}\n",
        (
            "components (line 3): the nodes do not hang together; found 2 parts: {engine, pinion, wheel}; "
            "{gruond}; allowed: 1 part; connect them by a shaft, a coupling or gears"
        ),
    ),
    (
        "self loop",
        "b: pinion, stiffness",
        "b: engine, stiffness",
        (
            "components.shaft.b (line 5): the component connects a node with itself; found 'engine'; name "
            "two different nodes"
        ),
    ),
    (
        "gear with itself",
        "b: wheel, ratio",
        "b: pinion, ratio",
        (
            "components.gear.b (line 7): the component connects a node with itself; found 'pinion'; name two "
            "different nodes"
        ),
    ),
    (
        "misspelt node",
        "b: pinion, stiffness",
        "b: pinoin, stiffness",
        (
            "components.shaft (line 5): node 'pinoin' has no inertia; did you mean 'pinion'? give the node "
            "an inertia; known nodes: engine, pinion, wheel"
        ),
    ),
    (
        "unknown node",
        "b: pinion, stiffness",
        "b: propeller, stiffness",
        (
            "components.shaft (line 5): node 'propeller' has no inertia; give the node an inertia; known "
            "nodes: engine, pinion, wheel"
        ),
    ),
    (
        "contradictory gears",
        "",
        "  second: {type: gear_pair, a: pinion, b: wheel, ratio: 3}\n",
        (
            "components.second (line 9): the gears 'gear', 'second' contradict one another: together they "
            "force 'wheel' to stand still; the ratios round a closed loop must multiply to 1"
        ),
    ),
    (
        "contradictory gears through a shaft",
        "",
        "  second: {type: gear_pair, a: engine, b: wheel, ratio: 3}\n",
        (
            "components (line 3): the gear ratios contradict one another: these nodes cannot turn together; "
            "found engine, pinion, wheel; the ratios round every closed loop, shafts included, must multiply "
            "to 1"
        ),
    ),
    (
        "gear to ground",
        "",
        (
            "  lock: {type: gear_pair, a: wheel, b: ground, ratio: 1}\n  lock2: {type: gear_pair, a: engine, "
            "b: ground, ratio: 1}\n"
        ),
        "components (line 3): every node is held by the ground; leave at least one node free to turn",
    ),
    (
        "ground as a name",
        "",
        "  ground: {type: inertia, inertia: 1}\n",
        (
            "components.ground (line 9): this cannot be a name; found 'ground', the node that never moves; "
            "allowed: 1 to 64 letters, digits and marks, but none of : = , ; * ? [ ] { } < > / | & nor quotes"
        ),
    ),
    (
        "standing ratio of one",
        "",
        "  set: {type: planetary_gear, sun: engine, ring: wheel, carrier: pinion, standing_ratio: 1}\n",
        "components.set.standing_ratio (line 9): a standing ratio of 1 leaves the carrier free; found 1",
    ),
    (
        "planetary twice the same node",
        "",
        "  set: {type: planetary_gear, sun: engine, ring: engine, carrier: pinion, standing_ratio: -2}\n",
        "components.set.sun, ring, carrier (line 9): sun, ring and carrier must be three different nodes",
    ),
    (
        "tube thicker than itself",
        "",
        (
            "  tube: {type: distributed_shaft, a: wheel, b: pinion, length: 1, outer_diameter: 0.1, "
            "inner_diameter: 0.2}\n"
        ),
        ("components.tube.outer_diameter - inner_diameter (line 9): must be positive; found -0.1; allowed: > 0 m"),
    ),
    (
        "no elements",
        "",
        ("  tube: {type: distributed_shaft, a: wheel, b: pinion, length: 1, outer_diameter: 0.1, elements: 0}\n"),
        "components.tube.elements (line 9): is too small; found 0; allowed: >= 1",
    ),
    (
        "damper without damping",
        "",
        "  air: {type: damper, a: wheel, damping: 0}\n",
        "components.air.damping (line 9): must be positive; found 0; allowed: > 0 Nm s/rad",
    ),
    (
        "pendulum without a carrier",
        "",
        "  pendulum: {type: centrifugal_pendulum, carrier: weel, mass: 1, distance: 0.1, order: 2}\n",
        (
            "components.pendulum (line 9): node 'weel' has no inertia; did you mean 'wheel'? give the node "
            "an inertia; known nodes: engine, pendulum, pinion, wheel"
        ),
    ),
    (
        "stages that fall",
        "  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}\n",
        (
            "  shaft: {type: coupling, a: engine, b: pinion, stages: [{up_to: 20, stiffness: 1e3}, {up_to: "
            "10, stiffness: 1e4}]}\n"
        ),
        (
            "components.shaft.stages.1.up_to (line 5): stages are listed with rising torques; found 10 Nm; "
            "allowed: > 20 Nm, the stage before"
        ),
    ),
    (
        "a stage without end in the middle",
        "  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}\n",
        ("  shaft: {type: coupling, a: engine, b: pinion, stages: [{stiffness: 1e3}, {up_to: 10, stiffness: 1e4}]}\n"),
        "components.shaft.stages.0.up_to (line 5): the torque at which the next stage begins is missing",
    ),
    (
        "stiffness and stages",
        "  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}\n",
        "  shaft: {type: coupling, a: engine, b: pinion, stiffness: 1e3, stages: [{stiffness: 1e3}]}\n",
        ("components.shaft (line 5): a spring has a stiffness or stages; found both; allowed: one of the two"),
    ),
    (
        "negative slope",
        "  shaft: {type: shaft, a: engine, b: pinion, stiffness: 1e4}\n",
        (
            "  shaft: {type: coupling, a: engine, b: pinion, hinges: {stiffness: 1e3, changes: [{angle: 0.1, "
            "side: 1, change: -2e3}]}}\n"
        ),
        "components.shaft (line 5): the stiffness must not be negative; found -1000 Nm/rad in one stage",
    ),
    (
        "unknown landmark",
        "",
        "landmarks: {load: weel}\n",
        "landmarks.load (line 9): there is no node 'weel'; did you mean 'wheel'?",
    ),
    (
        "unknown throws",
        "",
        "landmarks: {throws: [engin]}\n",
        "landmarks.throws (line 9): there is no node 'engin'; did you mean 'engine'?",
    ),
    (
        "unknown springs",
        "",
        "landmarks: {springs: shft}\n",
        "landmarks.springs (line 9): there is no component 'shft'; did you mean 'shaft'?",
    ),
    (
        "misspelt key of a component",
        "stiffness: 1e4",
        "stifness: 1e4",
        "components.shaft.stifness (line 5): the key is unknown; did you mean 'stiffness'?",
    ),
    (
        "missing key of a component",
        ", stiffness: 1e4",
        "",
        "components.shaft (line 5): the key 'stiffness' is missing; allowed: torsional stiffness [Nm/rad]",
    ),
    (
        "misspelt type",
        "type: shaft",
        "type: sahft",
        "components.shaft.type (line 5): there is no such type; found 'sahft'; did you mean 'shaft'?",
    ),
    (
        "missing type",
        "type: shaft, ",
        "",
        (
            "components.shaft (line 5): the key 'type' is missing; allowed: "
            "centrifugal_pendulum, coupling, damper, distributed_shaft, friction_washer, gear_pair, inertia, "
            "planet_spin, planetary_gear, shaft, superposition, tyre, vehicle"
        ),
    ),
    (
        "unknown choice",
        "",
        "  p: {type: centrifugal_pendulum, carrier: wheel, mass: 1, distance: 0.1, order: 2, path: oval}\n",
        (
            "components.p.path (line 9): is none of the choices; found 'oval'; allowed: circular, cycloid, "
            "epicycloid or tautochrone"
        ),
    ),
    (
        "misspelt block",
        "components:",
        "component:",
        "component (line 3): the key is unknown; did you mean 'components'?",
    ),
    (
        "misspelt version key",
        "torsional: 1",
        "torsionl: 1",
        "torsionl (line 1): the key is unknown; did you mean 'torsional'?",
    ),
    (
        "missing version",
        "torsional: 1\n",
        "",
        "the key 'torsional' is missing; allowed: version of this schema, as 'torsional: 1'",
    ),
    (
        "newer version",
        "torsional: 1",
        "torsional: 2",
        (
            "torsional (line 1): the file is written for a later torsional than this one; found 2; allowed: 1; "
            "install the later one"
        ),
    ),
    (
        "version as text",
        "torsional: 1",
        "torsional: '1'",
        ("torsional (line 1): this version of the file format is unknown; found '1'; allowed: 1; write 'torsional: 1'"),
    ),
    ("missing name", "name: line\n", "", "the key 'name' is missing; allowed: what it is, in words"),
    ("name is a number", "name: line", "name: 13", "name (line 2): a text is wanted; found 13"),
    (
        "HTML in a name",
        "  engine: {type",
        "  <script>alert(1)</script>: {type",
        (
            "components.<script>alert(1)</script> (line 4): this cannot be a name; found "
            "'<script>alert(1)</script>'; allowed: 1 to 64 letters, digits and marks, but none of : = , ; * "
            "? [ ] { } < > / | & nor quotes"
        ),
    ),
    (
        "HTML in a node",
        "inertia: 3}",
        "inertia: 3, node: '<b>wheel</b>'}",
        (
            "components.wheel.node (line 8): this cannot be a name; found '<b>wheel</b>'; allowed: 1 to 64 "
            "letters, digits and marks, but none of : = , ; * ? [ ] { } < > / | & nor quotes"
        ),
    ),
    (
        "formula as a name",
        "  engine: {type",
        "  =1+1: {type",
        (
            "components.=1+1 (line 4): this cannot be a name; found '=1+1'; allowed: 1 to 64 letters, digits "
            "and marks, but none of : = , ; * ? [ ] { } < > / | & nor quotes"
        ),
    ),
]


@pytest.mark.parametrize(("old", "new", "expected"), [case[1:] for case in MACHINE], ids=[case[0] for case in MACHINE])
def test_machine(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert message(tmp_path, swapped(LINE, old, new) if old else LINE + new) == expected


WHOLE = [
    (
        "no inertia at all",
        "torsional: 1\nname: n\ncomponents:\n  s: {type: shaft, a: x, b: y, stiffness: 1}\n",
        ("components (line 3): a powertrain needs at least one inertia; give every rotating body an inertia"),
    ),
    (
        "empty block",
        "torsional: 1\nname: n\ncomponents:\n",
        "components (line 3): the key has no value; give it one, or remove the line",
    ),
    (
        "block is a text",
        "torsional: 1\nname: n\ncomponents: none\n",
        "components (line 3): a block of keys is wanted; found 'none'",
    ),
    (
        "engine without throws",
        "torsional: 1\nname: n\nclutch: {inertia: 0.1, stiffness: 1e4, hub_stiffness: 1e5}\n",
        "clutch (line 3): a clutch needs a block 'absorber' to sit on; or write it as components",
    ),
]


@pytest.mark.parametrize(("text", "expected"), [case[1:] for case in WHOLE], ids=[case[0] for case in WHOLE])
def test_whole_file(tmp_path: Path, text: str, expected: str) -> None:
    assert message(tmp_path, text) == expected


# --- a block of the truck left out ---

BLOCKS = {
    "engine": ("crankshaft (line ?): the number of throws is not known; give an engine block, or crankshaft.throws"),
    "absorber": "crankshaft (line ?): a crankshaft needs a block 'absorber' to turn; or write it as components",
    "clutch": "gearbox (line ?): a gearbox needs a block 'clutch' before it; or write it as components",
    "gearbox": "driveline (line ?): a driveline needs a block 'gearbox' to hang on; or write it as components",
    "driveline": "vehicle (line ?): a vehicle needs a block 'driveline' to be moved by; or write it as components",
    "vehicle": "driveline (line ?): a driveline needs a block 'vehicle' to move",
}


@pytest.mark.parametrize(("block", "expected"), BLOCKS.items(), ids=BLOCKS)
def test_block_left_out(tmp_path: Path, block: str, expected: str) -> None:
    paragraphs = TRUCK.split("\n\n")
    text = "\n\n".join(part for part in paragraphs if not part.startswith(f"{block}:"))
    assert text != TRUCK
    named = expected.partition(" ")[0]
    assert message(tmp_path, text) == expected.replace("(line ?)", line_of(text, f"{named}:"))


# --- the file itself ---


FILES: list[tuple[str, bytes, str]] = [
    ("empty", b"", "the file is empty"),
    ("blanks", b" \n\n", "the file is empty"),
    ("comments only", b"# nothing\n", "the file holds no model, only comments or blanks"),
    ("a BOM only", b"\xef\xbb\xbf", "the file is empty"),
    ("UTF-16", LINE.encode("utf-16"), "the file is not UTF-8 but probably UTF-16; save it as UTF-8"),
    ("UTF-16 without mark", LINE.encode("utf-16-le"), "the file is not UTF-8 but probably UTF-16; save it as UTF-8"),
    (
        "Latin-1",
        LINE.replace("line", "Linie für Öl").encode("latin-1"),
        "line 2: the file is not UTF-8 text; found byte 0xfc at offset 26; save it as UTF-8",
    ),
    (
        "NUL",
        LINE.replace("line", "li\0ne").encode(),
        "line 2: the file holds a control character; found a NUL byte; remove it",
    ),
    (
        "escape code",
        LINE.replace("line", "\x1b[31mline").encode(),
        "line 2: the file holds a control character; found U+001B; remove it",
    ),
    (
        "truncated",
        TRUCK.encode()[: TRUCK.encode().index(b"stiffness") + 4],
        "the file holds no model, only comments or blanks",
    ),
    (
        "truncated in brackets",
        LINE.encode()[:100],
        (
            "line 5: this is not YAML: while parsing a flow mapping expected ',' or '}', but got '<stream "
            "end>' (begun on line 5); found 'shaft: {type: shaft, a'; close the brackets and put commas "
            "between the values"
        ),
    ),
    (
        "a bit flipped in a key",
        LINE.replace("inertia: 3", "knertia: 3").encode(),
        "components.wheel.knertia (line 8): the key is unknown; did you mean 'inertia'?",
    ),
    ("huge", b"#" * 300_000, "the file is too large; allowed: at most 256 000 bytes"),
    (
        "too many values",
        (
            "torsional: 1\nname: n\ncomponents:\n" + "".join(f"  p{i}: {{type: x, y: 1}}\n" for i in range(4000))
        ).encode(),
        "line 3336: the file holds too many values; allowed: at most 10000",
    ),
    ("a list", b"- torsional: 1\n", "line 1: the file must begin with keys, such as 'torsional: 1'; found a list"),
    ("a text", b"torsional\n", "line 1: the file must begin with keys, such as 'torsional: 1'; found 'torsional'"),
    (
        "tabs",
        LINE.replace("  engine", "\tengine").encode(),
        (
            "line 4: this is not YAML: while scanning for the next token found character '\\t' that cannot "
            "start any token; found 'engine: {type: inertia, inertia: 1.5}'; indent with blanks, not tabs"
        ),
    ),
    (
        "two documents",
        (LINE + "---\n" + LINE).encode(),
        "line 9: a second document begins here ('---'); allowed: one model a file",
    ),
]


@pytest.mark.parametrize(("data", "expected"), [case[1:] for case in FILES], ids=[case[0] for case in FILES])
def test_file(tmp_path: Path, data: bytes, expected: str) -> None:
    assert message(tmp_path, data) == expected.replace("line ?", line_of(TRUCK, "    stiffness").strip("()"))


def test_missing_file(tmp_path: Path) -> None:
    (tmp_path / "truck.yaml").write_text(LINE, encoding="utf-8")
    assert told(tmp_path / "truk.yaml") == "there is no such file; did you mean 'truck.yaml'?"


def test_folder(tmp_path: Path) -> None:
    assert told(tmp_path) == "this is a folder, not a file; name the file in it"


def test_no_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.yaml"
    path.write_text(LINE, encoding="utf-8")

    def refused(*_: object, **__: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", refused)  # root may read anything, so the system is made to refuse
    assert told(path) == "the file may not be read; ask for permission to read it"


# --- hostile texts ---


HOSTILE: list[tuple[str, str, str]] = [
    (
        "tag",
        LINE.replace("name: line", "name: !!python/object/apply:os.system [ls]"),
        (
            "line 2: YAML tags ('!') are not read; found '!!python/object/apply:os.system'; remove the tag, "
            "or quote a text that begins with '!'"
        ),
    ),
    (
        "anchor",
        LINE.replace("name: line", "name: &a line"),
        (
            "line 2: YAML anchors ('&') are not read; found '&a'; write the value out, or quote a text that "
            "begins with '&'"
        ),
    ),
    (
        "alias",
        LINE.replace("name: line", "name: *a"),
        (
            "line 2: YAML aliases ('*') are not read; found '*a'; write the value out, or quote a text that "
            "begins with '*'"
        ),
    ),
    (
        "merge",
        LINE.replace("  engine:", "  <<: {a: 1}\n  engine:"),
        "components (line 4): merge keys '<<' are not read; write the keys out",
    ),
    (
        "alias bomb",
        "a: &a [1,1]\nb: &b [*a,*a]\nc: [*b,*b]\n",
        (
            "line 1: YAML anchors ('&') are not read; found '&a'; write the value out, or quote a text that "
            "begins with '&'"
        ),
    ),
    (
        "depth bomb",
        "torsional: 1\nname: " + "[" * 5000,
        "line 2: the file is nested too deeply; allowed: at most 30 levels",
    ),
    (
        "block depth bomb",
        "".join(" " * i + "a:\n" for i in range(200)),
        "line 31: the file is nested too deeply; allowed: at most 30 levels",
    ),
    (
        "duplicate key",
        LINE.replace("name: line", "name: line\nname: other"),
        "name (line 3): the key stands twice; found it stands on line 2 already",
    ),
    (
        "directive",
        "%YAML 1.1\n---\n" + LINE,
        "line 2: only the directive '%YAML 1.2' is read; remove the line with '%'",
    ),
    (
        "number of thousand digits",
        LINE.replace("1.5", "9" * 1000),
        (
            "components.engine.inertia (line 4): a number this long is not read; found "
            "'99999999999999999999999999999999999999999999999999999999...; allowed: at most 40 digits"
        ),
    ),
    (
        "key with a dot",
        LINE.replace("  engine: ", "  a.b: "),
        (
            "components (line 4): this cannot be a key; found 'a.b'; allowed: 1 to 64 characters without a "
            "dot, since key paths are written with dots"
        ),
    ),
    (
        "key that is a number",
        LINE.replace("  engine: ", "  1: "),
        "components (line 4): a key must be a word; found '1'; put it in quotes",
    ),
]


@pytest.mark.parametrize(("text", "expected"), [case[1:] for case in HOSTILE], ids=[case[0] for case in HOSTILE])
def test_hostile(tmp_path: Path, text: str, expected: str) -> None:
    assert message(tmp_path, text) == expected


# --- the full-load curve beside the truck ---

HEAD = "speed [rpm],torque [Nm]\n"

CURVES: list[tuple[str, str | bytes | None, str]] = [
    ("missing", None, "engine.full_load (line ?): there is no such file; found 'truck13_full_load.csv'; known: m.yaml"),
    ("empty", "", "engine.full_load (line ?): the file is empty; found 'truck13_full_load.csv'"),
    (
        "header only",
        HEAD,
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': a table has a header and at least two "
            "rows; found 0 rows below 'speed [rpm],torque [Nm]'"
        ),
    ),
    (
        "one row",
        HEAD + "600,1300\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': a table has a header and at least two "
            "rows; found 1 row below 'speed [rpm],torque [Nm]'"
        ),
    ),
    (
        "no unit",
        "speed,torque [Nm]\n600,1\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': column 'speed': the header names no "
            "unit; write 'speed [rpm]'"
        ),
    ),
    (
        "wrong unit",
        "speed [Nm],torque [Nm]\n600,1\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': header, column 'speed': Nm is a torque, "
            "and an angular velocity is wanted; found '1 Nm'; allowed: rad/s, rpm, rev/s, deg/s"
        ),
    ),
    (
        "unknown column",
        "speed [rpm],torqe [Nm]\n600,1\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': header: the column is unknown; found "
            "'torqe [Nm]'; did you mean 'torque'?"
        ),
    ),
    (
        "missing column",
        "speed [rpm],speed [rpm]\n600,1\n700,2\n",
        "engine.full_load (line ?): in 'truck13_full_load.csv': column 'speed': the column stands twice",
    ),
    (
        "one column",
        "speed [rpm]\n600\n700\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': header: the column 'torque' is "
            "missing; found 'speed [rpm]'"
        ),
    ),
    (
        "decimal commas",
        "speed [rpm];torque [Nm]\n600;1,5\n700;2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2), column 'torque': a plain "
            "number is wanted; found '1,5'; write decimals with a point"
        ),
    ),
    (
        "decimal commas",
        HEAD + "600,1300,5\n700,1400,5\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2): 2 cells are wanted; "
            "found 3 cells in '600,1300,5'; decimals take a point; columns are separated by commas"
        ),
    ),
    (
        "text",
        HEAD + "600,much\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2), column 'torque': a plain "
            "number is wanted; found 'much'"
        ),
    ),
    (
        "NaN",
        HEAD + "600,nan\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2), column 'torque': a plain "
            "number is wanted; found 'nan'"
        ),
    ),
    (
        "formula",
        HEAD + "600,=1+1\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2), column 'torque': a plain "
            "number is wanted; found '=1+1'; write values, not formulas"
        ),
    ),
    (
        "falling speeds",
        HEAD + "700,1\n600,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 2 (line 3), column 'speed': the "
            "column must increase from row to row"
        ),
    ),
    (
        "equal speeds",
        HEAD + "600,1\n600,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 2 (line 3), column 'speed': the "
            "column must increase from row to row"
        ),
    ),
    (
        "negative torque",
        HEAD + "600,-1\n700,2\n",
        "engine.full_load (line ?): must not be negative; found -1; allowed: >= 0 Nm",
    ),
    (
        "a cell too few",
        HEAD + "600\n700,2\n",
        (
            "engine.full_load (line ?): in 'truck13_full_load.csv': row 1 (line 2): 2 cells are wanted; "
            "found 1 cells in '600'"
        ),
    ),
    (
        "binary",
        b"PK\x03\x04\x00\x00",
        (
            "engine.full_load (line ?): the file is not UTF-8 but probably UTF-16; found "
            "'truck13_full_load.csv'; save it as UTF-8"
        ),
    ),
    (
        "UTF-16",
        (HEAD + "600,1\n700,2\n").encode("utf-16"),
        (
            "engine.full_load (line ?): the file is not UTF-8 but probably UTF-16; found "
            "'truck13_full_load.csv'; save it as UTF-8"
        ),
    ),
]


@pytest.mark.parametrize(("curve", "expected"), [case[1:] for case in CURVES], ids=[case[0] for case in CURVES])
def test_curve(tmp_path: Path, curve: str | bytes | None, expected: str) -> None:
    assert message(tmp_path, TRUCK, curve) == expected.replace("(line ?)", line_of(TRUCK, "  full_load"))
