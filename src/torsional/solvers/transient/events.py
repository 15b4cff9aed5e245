"""When springs pass from one stage to another in time: contacts, stops, free play."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.laws import hinge_rows
from torsional.numerics.arrays import Array
from torsional.results import dataset
from torsional.system import System


@checked
def stage_changes(system: System, run: xr.Dataset) -> xr.Dataset:
    """Every passage of a spring from one stage to another in a ``run`` of `transient`, in the order of time.

    Dimension ``event``: ``time`` [s], ``element``, ``twist`` [rad], ``rate`` [rad/s] and the ``stage`` it enters, as
    the law names it.  Times are those of a cubic through the samples, so a run is best sampled at every step.
    Raises ModelError for a run of another system.

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.laws import Contacts
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.solvers.transient import MotionState, transient
    >>> from torsional.system import assemble
    >>> stop = Coupling("ground", "disc", Contacts((0.1,), (1.0,), (100.0,), (0.0,)))
    >>> line = assemble(Powertrain({"disc": Inertia(1.0), "stop": stop}))
    >>> run = transient(line, (), 0.6, MotionState.at_rest(line).moved(0.0, [1.0]), speed=0.0)
    >>> stage_changes(line, run).time.values.round(4).tolist()  # closed for π/10 s
    [0.1, 0.4142]
    """
    names = system.connections.names
    missing = [str(e) for e in run.element.values if str(e) not in names]
    if missing or "twist" not in run:
        raise ModelError("the run is not of this system", where="run", found=missing[0] if missing else "no twist")
    found = []
    for element in run.element.values:
        law = system.connections.laws[names.index(str(element))]
        rows = hinge_rows(law) if law is not None else None
        if law is None or rows is None:
            continue
        twist = run.twist.sel(element=element).values
        for gap in np.unique(rows.gap):
            for time, rate in _crossings(run.time.values, twist - gap):
                beyond = gap + np.sign(rate) * 1e-9 * max(abs(gap), 1e-3)
                found.append((time, str(element), gap, rate, law.stage_name(float(beyond))))
    found.sort(key=lambda event: event[0])
    times, element, twist, rates, stage = ([event[i] for event in found] for i in range(5))
    return dataset(
        {
            "element": (("event",), np.array(element, dtype=str), ""),
            "twist": (("event",), np.array(twist, dtype=float), "relative_angle"),
            "rate": (("event",), np.array(rates, dtype=float), "angular_velocity"),
            "stage": (("event",), np.array(stage, dtype=str), ""),
        },
        {"time": (np.array(times, dtype=float), "time", "event")},
        analysis="stage changes",
        amplitude="signal",
        system_hash=system.hash,
    )


def _crossings(time: Array, value: Array) -> list[tuple[float, float]]:
    """Times and rates at which sampled values pass zero, by cubics with the slopes of parabolas through neighbours."""
    slope = np.gradient(value, time, edge_order=2) if len(time) > 2 else np.gradient(value, time)
    places = np.flatnonzero((value[:-1] < 0) & (value[1:] >= 0) | (value[:-1] > 0) & (value[1:] <= 0))
    found = []
    for i in places:
        h = time[i + 1] - time[i]
        a, b, da, db = value[i], value[i + 1], h * slope[i], h * slope[i + 1]
        cubic = np.array([2 * a - 2 * b + da + db, 3 * b - 3 * a - 2 * da - db, da, a])
        roots = np.roots(cubic)
        real = roots[np.abs(roots.imag) < 1e-9].real
        inside = real[(real >= -1e-9) & (real <= 1 + 1e-9)]
        at = float(inside.min()) if inside.size else float(a / (a - b))
        found.append((float(time[i] + at * h), float(np.polyval(np.polyder(cubic), at) / h)))
    return found
