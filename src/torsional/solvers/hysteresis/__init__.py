"""Hysteresis loops of an absorber: torque over angle under a slow sweep at any rotational speed."""

from torsional.solvers.hysteresis.bench import Bench, on_bench
from torsional.solvers.hysteresis.courses import FINE, Course, Followed, followed
from torsional.solvers.hysteresis.sweeps import CLOSED, RATE, absorber_ends, hysteresis, model_hysteresis

__all__ = [
    "CLOSED",
    "FINE",
    "RATE",
    "Bench",
    "Course",
    "Followed",
    "absorber_ends",
    "followed",
    "hysteresis",
    "model_hysteresis",
    "on_bench",
]
