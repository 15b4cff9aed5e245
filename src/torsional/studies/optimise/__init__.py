"""Optimisation: the best designs for objectives under limits, their Pareto front, refined by exact gradients."""

from torsional.studies.optimise.optimise import optimise
from torsional.studies.optimise.task import Limit, Method

__all__ = ["Limit", "Method", "optimise"]
