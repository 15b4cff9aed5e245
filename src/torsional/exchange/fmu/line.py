"""A whole powertrain as a unit: torques on nodes in, motion of nodes and torques of elements out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from torsional.exchange.fmu.unit import (
    Output,
    Unit,
    Variable,
    element_output,
    node_outputs,
    numbered_laws,
    parameters_of,
    unique,
)
from torsional.numerics.motion.tables import LEVEL_OF, VALUE
from torsional.solvers.transient.drives import TorqueHistory
from torsional.solvers.transient.marching import Accuracy, standing_of
from torsional.solvers.transient.presented import kept
from torsional.solvers.transient.problem import Drives, Problem
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import starting
from torsional.system import System


def line_unit(
    system: System,
    name: str,
    inputs: Mapping[str, float],
    *,
    drives: Drives = (),
    speed: float | SpeedProfile = 0.0,
    hold: str = "",
    start: object = None,
    accuracy: Accuracy,
    outputs: Sequence[str] = (),
) -> Unit:
    """A ``system`` under ``drives`` of its own and under torques {node: Nm at the start} that come from outside.

    ``outputs`` names nodes and elements, all where it is empty; the other arguments are those of `transient`.
    """
    given = [TorqueHistory(node, (0.0,), (torque,)) for node, torque in inputs.items()]
    own = drives if isinstance(drives, Sequence) else (drives,)
    problem = Problem.of(system, [*own, *given], speed, hold=hold)
    motion = starting(start, problem.system, problem.acting, problem.hold, problem.start_speed)
    plan, kernels = numbered_laws(problem.plan, problem.system)
    last = len(problem.acting.sources) - bool(problem.hold)  # what takes up the mean torque stands behind
    return unique(
        Unit(
            name=name,
            description="Torsional vibrations of a powertrain",
            plan=plan,
            state=standing_of(problem, motion, accuracy.step),
            accuracy=accuracy,
            kernels=kernels,
            inputs=tuple(_input(node, torque) for node, torque in inputs.items()),
            levels=tuple(level_place(problem, source) for source in range(last - len(given), last)),
            sides=(),
            parameters=tuple(parameters_of(plan, problem.system)),
            outputs=tuple(_outputs(problem.system, outputs)),
        )
    )


def level_place(problem: Problem, source: int) -> int:
    """Where the level of a source, which has one knot, stands among the plan's knots, flat."""
    outside = problem.plan.outside
    knot = outside.level_start[outside.source_places[LEVEL_OF, source]]
    return int(VALUE * outside.knots.shape[1] + knot)


def _input(node: str, torque: float) -> Variable:
    return Variable(f"{node}.applied_torque", "N.m", f"torque on {node} from outside", float(torque))


def _outputs(system: System, names: Sequence[str]) -> list[Output]:
    nodes, elements = kept(names, system.nodes, system.connections.names)
    found = [output for i in nodes for output in node_outputs(system, system.nodes[i])]
    return found + [element_output(system, system.connections.names[e]) for e in elements]
