"""The search: genetic algorithms of pymoo, told the figures of every generation; one seed finds one set of designs."""

from __future__ import annotations

from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.studies.optimise.generations import Answers, Generations
from torsional.studies.optimise.task import Method, Task
from torsional.studies.sweeps.designs import hypercube

EXTRA = "pip install 'torsional[design]'"
BAD = 1e30
"""Objective of a design without an answer; it is beyond a limit too, so that any design with one is preferred."""


def pymoo() -> Any:
    """The library, imported where it is needed; ModelError, naming the extra, where it is not there."""
    try:
        import pymoo as library
    except ImportError:
        raise ModelError("optimisation needs pymoo, which is not installed", remedy=EXTRA) from None
    return library


def released() -> str:
    """The version of pymoo: another one may choose other designs."""
    return f"pymoo {pymoo().__version__}"


def searched(task: Task, method: Method, kept: Generations) -> None:
    """Work through all generations, the first of which holds a Latin hypercube and the nominal design.

    Several objectives: NSGA-II (Deb et al., IEEE Trans. Evol. Comput. 6 (2002) 182), from three on NSGA-III (Deb and
    Jain, ibid. 18 (2014) 577); one: differential evolution (Storn and Price, 1997).
    """
    pymoo()
    from pymoo.core.evaluator import Evaluator
    from pymoo.core.problem import Problem
    from pymoo.problems.static import StaticProblem

    axes = len(task.axes)
    problem = Problem(
        n_var=axes,
        n_obj=len(task.objectives),
        n_ieq_constr=1 + len(task.limits),
        xl=np.zeros(axes),
        xu=np.ones(axes),
    )
    algorithm = _algorithm(task, method)
    algorithm.setup(problem, termination=("n_gen", method.generations), seed=method.seed)
    number = 0
    while algorithm.has_next():
        number += 1
        asked = algorithm.ask()
        answers = kept.answers(number, task.columns(asked.get("X")))
        goals, beyond = scored(task, answers)
        Evaluator().eval(StaticProblem(problem, F=goals, G=beyond), asked)
        algorithm.tell(infills=asked)


def _algorithm(task: Task, method: Method) -> Any:
    begun = first(task, method)
    if len(task.objectives) == 1:
        from pymoo.algorithms.soo.nonconvex.de import DE

        return DE(pop_size=method.population, sampling=begun, variant="DE/rand/1/bin")
    if len(task.objectives) == 2:
        from pymoo.algorithms.moo.nsga2 import NSGA2

        return NSGA2(pop_size=method.population, sampling=begun)
    from pymoo.algorithms.moo.nsga3 import NSGA3
    from pymoo.util.ref_dirs import get_reference_directions

    count = len(task.objectives)
    parts = 1
    while _directions(parts + 1, count) <= method.population:
        parts += 1
    return NSGA3(get_reference_directions("das-dennis", count, n_partitions=parts), method.population, sampling=begun)


def _directions(parts: int, count: int) -> int:
    from math import comb

    return comb(parts + count - 1, count - 1)


def first(task: Task, method: Method) -> Array:
    """The first generation (designs, parameters) as shares of the axes."""
    shares = hypercube(method.population, len(task.axes), method.seed)
    if task.nominal_share is not None:
        shares[0] = task.nominal_share
    return shares


def scored(task: Task, answers: Answers) -> tuple[Array, Array]:
    """Objectives to be made small (designs, objectives), and what must not be above 0 (designs, 1 + limits)."""
    task.refuse_unknown(answers.figures or dict.fromkeys(task.wanted))
    good = answers.answered
    goals = np.full((good.size, len(task.objectives)), BAD)
    beyond = np.ones((good.size, 1 + len(task.limits)))
    for place, name in enumerate(task.objectives):
        if name in answers.figures:
            goals[good, place] = task.sign(name) * answers.figures[name][good]
    beyond[good, 0] = 0.0
    for place, (name, limit) in enumerate(task.limits.items(), 1):
        if name in answers.figures:
            beyond[good, place] = limit.beyond(answers.figures[name][good])
    return goals, beyond
