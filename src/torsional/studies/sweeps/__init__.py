"""Sweeps: one analysis of very many designs, in durable pieces, on one core or many machines."""

from torsional.studies.sweeps.bands import bands
from torsional.studies.sweeps.designs import Axis, Designs, grid, sampled, table
from torsional.studies.sweeps.sensitivity import sensitivities
from torsional.studies.sweeps.sweep import sweep

__all__ = ["Axis", "Designs", "bands", "grid", "sampled", "sensitivities", "sweep", "table"]
