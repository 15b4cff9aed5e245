"""Chosen designs over speed: what their figures are the worst of."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.friction import answered
from torsional.studies.optimise.result import chosen
from torsional.studies.optimise.task import Task
from torsional.studies.sweeps.absorbers import EnvelopeRun, FrictionRun
from torsional.studies.sweeps.criteria import CriteriaRun
from torsional.units import RPM

STEP = 10 * RPM


def curves_of(task: Task, data: xr.Dataset) -> tuple[xr.Dataset, str]:
    """Accelerations at the gearbox input (role, speed) of the designs that stand out, and in words what they are.

    Raises ModelError for models that have no such curve.
    """
    best = chosen(data)
    models = [_model(task, best.isel(design=place)) for place in range(best.sizes["design"])]
    if not models or not isinstance(models[0], Model) or not models[0].landmarks.input:
        raise ModelError("these are no vehicles with a gearbox input", where="landmarks.input")
    speed, rows, words = _rows(task, models)
    told = labelled(
        {"acceleration": (("role", "speed"), rows, "acceleration")},
        {"role": (best.role.values, ""), "speed": (speed, "speed")},
        analysis="chosen designs",
    )
    return told, words


def _model(task: Task, one: xr.Dataset) -> Any:
    values = {name: one[name].item() for name in task.axes}
    values = {name: None if isinstance(v, float) and np.isnan(v) else v for name, v in values.items()}
    return changed(task.build, values) if isinstance(task.build, Model) else task.build(**values)


def _rows(task: Task, models: list[Model]) -> tuple[Array, Array, str]:
    asked = task.run.ask.values() if isinstance(task.run, CriteriaRun) else ()
    frictions = [each for each in asked if isinstance(each, FrictionRun)]
    if frictions:
        ends = frictions[0].ends(models[0])
        speed = np.arange(ends[0], ends[1], STEP)
        found = [answered(model, ends, frictions[0].element) for model in models]
        rows = np.array([np.interp(speed, one.speed, one.amplitude) for one in found])
        return speed, rows, "firing order in top gear at 60 % of the full-load peak, the washer sliding and sticking"
    known = [each for each in asked if isinstance(each, EnvelopeRun)]
    run = EnvelopeRun(analysis="envelope", speed=None, step=STEP, orders=known[0].orders if known else [])
    tables = [run(model).acceleration_swing for model in models]
    words = "the worst of all gears and mean torques within full load, linear"
    return tables[0].speed.values, np.array([table.max("gear").values for table in tables]), words
