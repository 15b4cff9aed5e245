"""Tables of runs in time."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.absorbers import CentrifugalPendulum
from torsional.cli.runs import run_tables
from torsional.components import Inertia, Shaft
from torsional.engine import Excitation
from torsional.powertrain import Powertrain
from torsional.solvers.transient import transient
from torsional.studies.scenarios.running import with_figures
from torsional.system import assemble


def test_pendulums_have_a_row_beside_the_springs_with_stops() -> None:
    pendulum = CentrifugalPendulum("rotor", 1.0, 0.15, 3.0, stop=0.006)
    parts = {"rotor": Inertia(0.5), "load": Inertia(3.0), "shaft": Shaft("rotor", "load", 1e4, 20.0), "mass": pendulum}
    system = assemble(Powertrain(parts))
    run = transient(system, Excitation(("rotor",), [3.0], 100.0, [[400.0]]), 0.5, "rest")
    tables = {table.title: table for table in run_tables(with_figures(run, [system], []), "", [])}
    ((name, low, high, stop, left, contacts),) = tables["Springs against their stops"].rows
    assert (name, stop, left) == ("mass", pytest.approx(0.04), 0.0)
    swing = run.twist.sel(element="mass.suspension").values
    assert low == swing.min() < -0.04 and high == swing.max() > 0.04
    assert contacts == np.count_nonzero(np.diff(np.abs(swing) > 0.04, prepend=False) & (np.abs(swing) > 0.04)) > 2
