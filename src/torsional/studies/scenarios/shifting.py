"""The whole of a gear shift: the old gear, neutral with the cones of the new one rubbing, the new gear."""

from __future__ import annotations

from dataclasses import dataclass

from torsional.components import GearPair
from torsional.components.synchroniser import Synchroniser
from torsional.errors import ModelError
from torsional.files.shift_schema import GearShift
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.transient.acting import Drive
from torsional.solvers.transient.drives import Governor, TorqueHistory
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.stamps import Mass
from torsional.studies.scenarios import lines, sizes
from torsional.studies.scenarios.driving import MIDDLE, ROLLING, in_gear, within_stop
from torsional.studies.scenarios.lines import SYNCHRONISER
from torsional.studies.scenarios.plan import Phase, Plan, Span
from torsional.studies.scenarios.schedule import NEVER, HeldBack, Knots, cylinders, heat_for
from torsional.studies.trucks import reached
from torsional.units import show

RUBBING, PRESSED = 0.6, 0.1
"""Shares of its time that a synchroniser rubs, where no torque is given, and after which its cones are pressed."""
STUCK = 0.01
"""Turn [rad] over which cones that stick take up their torque."""
DAMPED = 1e-3
"""Damping of cones over their stiffness [s]."""
DROOP = 15.0
"""Speed [rad/s] by which an engine must be off that of the new gear for all of its torque."""
ROUNDING = 1e-9
CARRIED = 0.4
"""Share of full load that the engine may use to come up to speed."""


@dataclass(frozen=True, eq=False)
class Shift:
    """The lines of a shift: ``old`` and ``new`` gear with open linings, ``neutral``; ``ratio``: speed of the gearbox
    input in the new gear over that in the old one; what linings and cones carry [Nm]."""

    old: Powertrain
    neutral: Powertrain
    new: Powertrain
    ratio: float
    capacity: float
    cones: float


def gear_shift(block: GearShift, model: Model) -> Plan:
    """Three lines one after the other; heat follows the torques asked for and, in neutral, the new gear's speed."""
    speed, old, new = sizes.speed(model, block.speed, MIDDLE), *_gears_of(block, model)
    after = sizes.torque(model, block.torque, 0.4, "torque")
    before = after if block.before is None else block.before
    for gear, key, torque in ((old, "before", before), (new, "torque", after)):
        within_stop(model, gear, **{key: torque})
    shift = _lines_of(block, model, old, new, speed)
    if before > shift.capacity:
        told = {"found": show(before, "torque"), "allowed": f"up to {show(shift.capacity, 'torque')}"}
        raise ModelError(
            "the clutch would slip before the shift", where="before", **told, remedy="give it more capacity"
        )
    return Plan(
        **in_gear(block, model, shift.old, f"{old} to {new}", lines.LININGS),
        nodes=tuple(node for node in (model.landmarks.input, lines.load_of(model)) if node),
        drives=_drives_of(block, model, speed, before, after),
        speed=speed,
        start="vibrating",
        stuck=(lines.LININGS,),
        levels={"clutch": _clutch_over(block), SYNCHRONISER: _cones_over(block)},
        shown={
            "engine torque asked for": (_torque_over(block, before, 0.0, after), "torque"),
            "clutch capacity": (_times(_clutch_over(block), shift.capacity), "torque"),
            "synchroniser": (_times(_cones_over(block), shift.cones), "torque"),
        },
        later=(Span(block.synchroniser.begins, shift.neutral), Span(_engaged(block), shift.new)),
        phases=_phases_of(block, old, new),
    )


def _gears_of(block: GearShift, model: Model) -> tuple[str, str]:
    """Names of the old and the new gear; ModelError where they are none, or one."""
    if len(model.gears) < 2:
        raise ModelError("a shift needs two gears", where="gears", found=f"{len(model.gears)}")
    old = lines.gear_of(model, block.from_gear, -2, "from_gear")
    new = lines.gear_of(model, block.to_gear, -1, "to_gear")
    if old == new:
        raise ModelError("the gear stays the same", where="to_gear", found=f"'{new}'", remedy="name another one")
    return old, new


def _lines_of(block: GearShift, model: Model, old: str, new: str, speed: float) -> Shift:
    """The lines of a shift; ModelError where nothing in the new gear can be synchronised, or the engine over-speeds."""
    load = lines.load_of(model)
    first, _, capacity = lines.with_linings(lines.line_of(model, old), model, block.clutch)
    last, _, _ = lines.with_linings(lines.line_of(model, new), model, block.clutch)
    if set(first.nodes) != set(last.nodes):
        found = ", ".join(sorted(set(first.nodes) ^ set(last.nodes))[:6])
        raise ModelError("the gears have nodes of their own, which nothing brings to speed", where="gears", found=found)
    ratio = first.speed_ratio(load) / last.speed_ratio(load)
    if ratio <= 0:
        raise ModelError("the vehicle would turn the engine backwards", where="to_gear", found=f"'{new}'")
    _within_range(model, speed * ratio, new)
    name, pair = _meshing_in(model, new, last)
    cones = block.synchroniser.torque or _enough(block, last, name, pair, speed * (1.0 - ratio))
    values = {"stiffness": cones / STUCK, "damping": DAMPED * cones / STUCK}
    rubbing = Synchroniser(pair.a, pair.b, pair.ratio, cones, level=SYNCHRONISER, **values)
    parts = {SYNCHRONISER if part == name else part: made for part, made in last.components.items()}
    neutral = Powertrain({**parts, SYNCHRONISER: rubbing}, last.parts, last.reference)
    return Shift(first, neutral, last, ratio, capacity, cones)


def _within_range(model: Model, speed: float, gear: str) -> None:
    """Refuse a gear in which the engine would turn slower than idle, or faster than it runs."""
    low, high = model.operation.idle, model.operation.speed[1]
    if not low * (1 - ROUNDING) <= speed <= high * (1 + ROUNDING):
        problem = f"the engine would turn too {'fast' if speed > high else 'slowly'} in gear '{gear}'"
        told = {"found": show(speed, "speed"), "allowed": f"{show(low, 'speed')} to {show(high, 'speed')}"}
        raise ModelError(problem, where="to_gear", **told, remedy="name a gear closer by, or another speed before")


def _meshing_in(model: Model, gear: str, line: Powertrain) -> tuple[str, GearPair]:
    """The gear pair of a gear without which its line falls apart between engine and vehicle."""
    crank, load = lines.crank_of(model), lines.load_of(model)
    for name, part in model.gears[gear].components.items():
        if isinstance(part, GearPair) and load not in reached(line, [crank], [name]):
            return name, part
    remedy = "give each gear a gear pair between gearbox input and output"
    raise ModelError(f"gear '{gear}' has no pair of gears to be engaged", where="to_gear", remedy=remedy)


def _enough(block: GearShift, line: Powertrain, name: str, pair: GearPair, slip: float) -> float:
    """Torque [Nm] of cones that bring all between linings and gear pair to speed in their time, ``slip`` [rad/s] being
    seen at the engine."""
    turning = reached(line, [pair.a], [name, lines.LININGS])
    return max(
        abs(_inertia(line, turning) * slip / line.speed_ratio(pair.a)) / (RUBBING * block.synchroniser.within), 1.0
    )


def _inertia(line: Powertrain, nodes: set[str]) -> float:
    """Inertia of what turns on nodes, as at the engine [kgm²]."""
    masses = [mass for mass in line.stamps if isinstance(mass, Mass) and set(mass.weights) <= nodes]
    turning = [sum(w * line.speed_ratio(node) for node, w in mass.weights.items()) for mass in masses]
    return sum(mass.inertia * speed**2 for mass, speed in zip(masses, turning, strict=True))


def _drives_of(block: GearShift, model: Model, speed: float, before: float, after: float) -> tuple[Drive, ...]:
    """Engine, road, what keeps the line from accelerating before the time zero, and the governor of neutral."""
    crank, load = lines.crank_of(model), lines.load_of(model)
    least = max(before, after, 1.0)
    full = model.full_load_curve is not None
    most, shares = heat_for(
        model, speed, [max(least, CARRIED * model.full_load_peak() if full else 0.0), before, 0.0, after]
    )
    motor = cylinders(model, speed, most, _heat_over(block, *shares[1:]))
    resistance = sizes.at_wheels(model, block.road_load, ROLLING, "road_load")
    road = TorqueHistory(load, (0.0,), (-resistance,))
    held = HeldBack((motor, road))
    begin, end = block.synchroniser.begins, block.clutch.engages
    wanted = SpeedProfile((0.0, begin, begin, end, end), (NEVER, NEVER, *(shares[2] * DROOP,) * 2, NEVER))
    governor = Governor(crank, wanted, proportional=1.0 / DROOP, low=0.0, high=1.0, against=load)
    return motor, road, held, governor


def _torque_over(block: GearShift, before: float, none: float, after: float) -> Knots:
    """Ramped down, none, ramped up."""
    off, on = (
        (block.torque_off, block.torque_off + block.off_within),
        (block.torque_from, block.torque_from + block.torque_within),
    )
    return (*off, *on), (before, none, none, after)


def _heat_over(block: GearShift, before: float, none: float, after: float) -> Knots:
    """Shares of heat: as the torque, but nought while the governor gives it."""
    times, values = _torque_over(block, before, none, after)
    begin, end = block.synchroniser.begins, block.clutch.engages
    return (*times[:2], begin, begin, end, end, *times[2:]), (*values[:2], none, 0.0, 0.0, none, *values[2:])


def _clutch_over(block: GearShift) -> Knots:
    """Share of its capacity over time."""
    clutch = block.clutch
    times = (clutch.opens, clutch.opens + clutch.opens_within, clutch.engages, clutch.engages + clutch.within)
    return times, (1.0, 0.0, 0.0, 1.0)


def _cones_over(block: GearShift) -> Knots:
    """Share of the synchroniser's torque over time."""
    begin, end = block.synchroniser.begins, _engaged(block)
    return (begin, begin + PRESSED * (end - begin), end, end), (0.0, 1.0, 1.0, 0.0)


def _engaged(block: GearShift) -> float:
    return block.synchroniser.begins + block.synchroniser.within


def _phases_of(block: GearShift, old: str, new: str) -> tuple[Phase, ...]:
    """What happens, one after the other."""
    clutch, begin, end = block.clutch, block.synchroniser.begins, _engaged(block)
    named = {
        f"gear {old}": block.torque_off,
        "torque off": clutch.opens,
        "clutch opens": begin,
        "neutral": end,
        "clutch open": clutch.engages,
        "clutch closes": max(clutch.engages + clutch.within, block.torque_from),
        f"gear {new}": block.duration,
    }
    ends = [min(moment, block.duration) for moment in named.values()]
    return tuple(Phase(*told) for told in zip(named, [0.0, *ends[:-1]], ends, strict=True) if told[2] > told[1])


def _times(knots: Knots, factor: float) -> Knots:
    return knots[0], tuple(factor * value for value in knots[1])
