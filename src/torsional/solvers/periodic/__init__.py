"""Periodic steady states of systems with force laws."""

from torsional.solvers.periodic.boundary import subharmonic_boundary
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.machine import model_response, varied_response
from torsional.solvers.periodic.response import Variation, periodic_response
from torsional.solvers.periodic.subharmonic import subharmonic_map

__all__ = [
    "Load",
    "Variation",
    "model_response",
    "periodic_response",
    "subharmonic_boundary",
    "subharmonic_map",
    "varied_response",
]
