"""What a run must say of itself: dampers that the step gave to stops, energy that the steps made or took away."""

from __future__ import annotations

from torsional.solvers.transient.marching import Accuracy, Marched, method_share
from torsional.solvers.transient.problem import Problem

TOLD = 0.01
"""Share of all energy that passed through from which it is told."""
STIFF = 0.5
"""h ω of a closed contact from which the guard gives it a contact time of half a step."""
_MOST = 4


def honest(problem: Problem, told: Marched, accuracy: Accuracy) -> dict[str, str]:
    """``guarded`` and ``energy_error`` in words, where there is something to say."""
    if accuracy.method == "explicit":
        return {}
    said = {}
    hinges, names = problem.plan.hinges, problem.system.connections.names
    stiff = accuracy.step * hinges.pace > STIFF
    raised = stiff & (hinges.contact_time < 0.5 * accuracy.step)
    if raised.any():
        listed = list(dict.fromkeys(names[e] for e in hinges.of[raised]))
        more = f" and {len(listed) - _MOST} more" if len(listed) > _MOST else ""
        said["guarded"] = (
            f"{', '.join(listed[:_MOST])}{more}: stiffer than the step of {accuracy.step:.3g} s can follow, "
            "so that their contacts are given a damper; a smaller step has none"
        )
    share = method_share(told)
    if abs(share) > TOLD:
        did = "made" if share > 0 else "took away"
        said["energy_error"] = (
            f"the time steps {did} {abs(share):.2g} of the energy that passed through; take a smaller step"
        )
    return said
