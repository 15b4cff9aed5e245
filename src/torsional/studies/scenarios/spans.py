"""Runs over several lines, one after the other, as one: signals of all, the energies of the whole motion."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr

from torsional.solvers.transient.marching import COMPLETE
from torsional.solvers.transient.run import Progress, transient
from torsional.solvers.transient.starts import MotionState
from torsional.studies.scenarios.joining import Turning, carried_over
from torsional.studies.scenarios.lines import SYNCHRONISER
from torsional.studies.scenarios.plan import Plan

ENGAGING, STORED = "engaging", ("kinetic", "strain")
"""The share of energy that is lost as a gear engages at speeds that differ; those that are there at a moment."""


def moved(plan: Plan, step: float, output: float, progress: Progress | None) -> tuple[xr.Dataset, tuple[Turning, ...]]:
    """The run of a plan from its settling on, and its lines with their systems."""
    turning, ends = lines_of(plan)
    state, runs = plan.started(turning[0].system).since(-plan.settling), []
    for place, (own, end) in enumerate(zip(turning, ends, strict=True)):
        if place:
            state = carried_over(state, turning[place - 1], own, plan.crank)
        runs.append(_one(plan, own, state, end, step, output, _within(progress, plan.duration)))
        if runs[-1].attrs["status"] != COMPLETE:
            break
        state = MotionState.ending(runs[-1], own.system)
    return (_as_one(runs, turning) if plan.later else runs[0]), turning


def lines_of(plan: Plan) -> tuple[tuple[Turning, ...], list[float]]:
    """The lines of a plan with their systems, and when each ends [s]."""
    frame = float(plan.speed) if plan.later else 0.0  # type: ignore[arg-type]
    turning = tuple(Turning.of(line, frame) for line in (plan.line, *(span.line for span in plan.later)))
    return turning, [*(span.at for span in plan.later), plan.duration]


def _one(
    plan: Plan, own: Turning, state: MotionState, end: float, step: float, output: float, progress: Progress | None
) -> xr.Dataset:
    return transient(
        own.system,
        plan.drives,
        end - state.time,
        state,
        speed=plan.speed,
        hold=plan.hold,
        levels=plan.levels,
        reference=plan.crank,
        reference_time=plan.following,
        step=step,
        output=output,
        progress=progress,
    )


def _within(progress: Progress | None, whole: float) -> Progress | None:
    return None if progress is None else lambda at, end, pace: progress(at, whole, pace)


def _as_one(runs: Sequence[xr.Dataset], turning: Sequence[Turning]) -> xr.Dataset:
    """Runs that follow one another as one, angles counted from the last line's mean rotation, energies those of the
    whole speeds; an element that a line does not have carries nothing there."""
    last = turning[len(runs) - 1]
    shown = [_counted(run, own, last) for run, own in zip(runs, turning, strict=False)]
    parts = {str(name): list(dict.fromkeys(n for run in shown for n in run[name].values)) for name in _NAMED}
    signals = [run[[name for name in run.data_vars if "time" in run[name].dims]] for run in shown]
    filled = [run.reindex({k: v for k, v in parts.items() if k in run.dims}, fill_value=0.0) for run in signals]
    following = [run.isel(time=slice(1, None)) if place else run for place, run in enumerate(_summed(filled))]
    whole = xr.concat(following, "time", data_vars="minimal", coords="minimal", compat="override", join="override")
    ends = runs[-1][[name for name in runs[-1].data_vars if str(name).startswith("end_")]]
    return whole.merge(ends).assign_attrs(_attributes(runs) | _hard(whole))


def _hard(run: xr.Dataset) -> dict[str, str]:
    """What is to be said where a gear engaged before its synchroniser was done."""
    gone, known = float(run.energy.sel(share=ENGAGING)[-1]), "friction_loss" in run and SYNCHRONISER in run.rubbing
    if not known or gone <= HARD * float(run.friction_loss.sel(rubbing=SYNCHRONISER)[-1]):
        return {}
    told = f"the gear engaged before its synchroniser was done, {gone:.3g} J were lost at once"
    return {"unsynchronised": f"{told}; give it more time or torque"}


HARD = 0.05
"""Share of what the cones take from which the loss of a gear that engages is told."""
_NAMED = ("element", "friction", "loaded", "rubbing")


def _counted(run: xr.Dataset, own: Turning, last: Turning) -> xr.Dataset:
    """Angles against the last line's rotation; kinetic energy and work of the sources of the whole speeds."""
    ratios = [turned.system.speed_ratio for turned in (own, last)]
    angle = run.angle + np.multiply.outer(run.crank_angle.values, ratios[0] - ratios[1])
    energy, speeds = run.energy.copy(), run.angular_velocity.values
    momentum = own.momentum(speeds)
    energy.loc[{"share": "kinetic"}] = own.kinetic(speeds)
    energy.loc[{"share": "sources"}] += own.frame * (momentum - momentum[0])
    told = {"angle": angle.assign_attrs(run.angle.attrs), "energy": energy.assign_attrs(run.energy.attrs)}
    return run.assign(told).assign_coords(speed_ratio=run.speed_ratio.copy(data=ratios[1]))


def _summed(runs: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Energies counted from the beginning of the first; what is gone where lines change is a share of its own."""
    found: list[xr.Dataset] = []
    for run in runs:
        begun = found[-1].isel(time=-1, drop=True) if found else None
        gone = xr.zeros_like(run.energy.isel(share=[0])).assign_coords(share=[ENGAGING])
        told = {"energy": xr.concat([run.energy, gone], "share").transpose("time", "share")}
        if begun is not None:
            stored = told["energy"].share.isin(STORED)
            there = begun.energy - told["energy"].isel(time=0)
            told["energy"] = told["energy"] + begun.energy.where(~stored, 0.0)
            told["energy"].loc[{"share": ENGAGING}] += float(there.sel(share=list(STORED)).sum())
            told |= {"friction_loss": run.friction_loss + begun.friction_loss} if "friction_loss" in run else {}
        kept = run.drop_vars(["energy", "share"])
        found.append(kept.assign({name: value.assign_attrs(run[name].attrs) for name, value in told.items()}))
    return found


def _attributes(runs: Sequence[xr.Dataset]) -> dict[str, object]:
    """Those of the last run; counts summed, what any of them says of itself, the worst share of the method."""
    attrs: dict[str, object] = {}
    for run in runs:
        attrs |= run.attrs
    shares = np.array([run.attrs["method_share"] for run in runs])
    sums = {name: int(sum(run.attrs[name] for run in runs)) for name in ("steps", "iterations")}
    hashes = json.dumps([run.attrs["system_hash"] for run in runs])
    return attrs | sums | {"method_share": float(shares[np.abs(shares).argmax()]), "system_hash": hashes}
