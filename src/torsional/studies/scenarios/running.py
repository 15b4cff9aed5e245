"""A scenario from file and model to a run with its figures."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.scenario import load_scenario
from torsional.files.scenario_blocks import Scenario
from torsional.laws import Law
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import of_model
from torsional.solvers.transient.run import Progress
from torsional.solvers.transient.speed_profile import as_speed
from torsional.studies.scenarios.figures import phased, read_off, scheduled
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.spans import moved
from torsional.system import System
from torsional.units import show

FINEST, SLOWEST = 0.01, 60.0
"""Share of a turn of the crank that a step may take, at its speed or at this one [rad/s] where it is slower."""
TABS = {"_secondary_drive": 1.0, "_secondary_coast": -1.0}
"""Ends of the names of tabs by which springs rest on the flywheel that carries the clutch; a tab's torque is that by
which it is pushed, and on coast this is against the torque of the flywheel."""
STEP, OUTPUT = 1e-4, 2e-4
"""Time step, and interval of what is recorded [s], where nothing else is asked for."""


@checked
def run_scenario(model: Model, scenario: Scenario | str, progress: Progress | None = None) -> xr.Dataset:
    """What happens to a model in a scenario: the Dataset of `transient` with peaks, travels and contacts.

    ``scenario``: as `load_scenario` gives it, or the name of a kind or of a file, which is loaded as it is.
    ``schedule`` (event, time) is what was done, ``phase_speed`` (phase, node) how fast all was at the end of each phase
    of a shift; attributes name scenario, gear and what is worth looking at.
    Interrupted from the keyboard it gives what was reached, ``status`` says so.
    Raises ModelError for gears, nodes, torques and values that cannot be, and for steps too large for the line.
    """
    block = load_scenario(scenario) if isinstance(scenario, str) else scenario
    run = run_plan(planned(block, model), progress)
    return of_model(run.assign_attrs(scenario=block.scenario), model)


def run_plan(plan: Plan, progress: Progress | None = None) -> xr.Dataset:
    """The run of a plan."""
    refuse_coarse(plan)
    step = plan.step or STEP
    run, turning = moved(plan, step, max(OUTPUT, step), progress)
    plan, again = released(plan, run.time.values, run.angular_velocity.sel(node=plan.crank).values)
    if again:
        run, turning = moved(plan, step, max(OUTPUT, step), progress)
    run = _from_zero(run)
    refuse_refined(plan, "refined" in run.attrs, run.attrs["step"])
    named = {"title": plan.title, "gear": plan.gear, "crank": plan.crank}
    listed = {"springs": plan.springs, "watched": plan.watched, "looked_at": plan.nodes}
    told = {key: json.dumps(names) for key, names in listed.items()}
    run = with_tabs(run, plan.springs, plan.inner)
    systems = [own.system for own in turning]
    figures = with_figures(run, systems, (*plan.springs, *plan.watched), plan.inner)
    whole = phased(scheduled(figures, plan.shown), plan.phases, plan.crank)
    return whole.assign_attrs({**named, **told})


def released(plan: Plan, time: Array, crank: Array) -> tuple[Plan, bool]:
    """The plan with the starter off from the moment on at which the ``crank`` reached its speed [rad/s] over ``time``
    [s] in a run of the plan; whether the starter pushed again behind it, so that the run is another one."""
    if plan.release is None:
        return plan, False
    speed, free, until, off = plan.release
    reached = time[(crank >= speed) & (time < until)]
    if not reached.size:
        return plan, False
    pushed = (crank < free) & (time > reached[0]) & (time < until)
    return off(float(reached[0])), bool(pushed.any())


def refuse_coarse(plan: Plan) -> None:
    """Refuse steps over which the crank turns too far for its torques to be seen."""
    most = FINEST * 2 * np.pi / max(*as_speed(plan.speed).range, SLOWEST)
    if plan.step is not None and plan.step > most:
        told = {
            "found": show(plan.step, "time"),
            "allowed": f"a hundredth of a turn of the crank, {show(most, 'time')}",
        }
        raise ModelError("the step is too large", where="step", **told)


def refuse_refined(plan: Plan, refined: bool, step: float) -> None:
    """Refuse a step that was asked for and had to be made smaller, ``step`` [s] at the end."""
    if plan.step is not None and refined:
        told = {"found": f"{plan.step:g} s", "allowed": f"about {step:g} s"}
        raise ModelError("the step is too large for this line", where="step", **told, remedy="or leave the key out")


def _from_zero(run: xr.Dataset) -> xr.Dataset:
    """What happened from the time zero on, energies counted from there; KeyboardInterrupt where it was not reached."""
    late = run.time.values >= -0.25 * float(run.attrs["step"])
    if not late.any():
        raise KeyboardInterrupt
    if late.all():
        return run
    kept = run.isel(time=late)
    counted = {name: kept[name] for name in ("energy", "friction_loss") if name in kept}
    return kept.assign({name: (all_ - all_.isel(time=0)).assign_attrs(all_.attrs) for name, all_ in counted.items()})


def with_tabs(run: xr.Dataset, springs: Sequence[str], inner: Collection[str]) -> xr.Dataset:
    """The run with what the tabs of a detailed dual mass flywheel carry counted as its torque, beside its end stop."""
    parts = [str(name) for name in run.element.values if name in inner]
    if not any(name.endswith(tuple(TABS)) for name in parts) or len(springs) != 1:
        return run
    whole = run.torque
    for end, sign in TABS.items():
        tabs = [name for name in parts if name.endswith(end)]
        whole = whole + sign * run.torque.sel(element=tabs).sum("element") * (run.element == springs[0])
    return run.assign(torque=whole.transpose(*run.torque.dims).assign_attrs(run.torque.attrs))


def with_figures(
    run: xr.Dataset, systems: Sequence[System], first: Sequence[str], inner: Collection[str] = ()
) -> xr.Dataset:
    """The run with what `read_off` adds; ``told`` names the elements worth a row, some ``first``, dampers and ``inner``
    ones left out.  ``systems``: all that moved in it."""
    laws: dict[str, Law | None] = {}
    carrying: dict[str, None] = {}
    for c in (system.connections for system in systems):
        laws |= dict(zip(c.names, c.laws, strict=True))
        carrying |= dict.fromkeys(n for n, k in zip(c.names, c.stiffness, strict=True) if k > 0 or laws[n] is not None)
    outer = [name for name in carrying if name not in inner]
    listed = [name for name in dict.fromkeys([*first, *outer]) if name in run.element.values]
    return read_off(run, laws).assign_attrs(told=json.dumps(listed))
