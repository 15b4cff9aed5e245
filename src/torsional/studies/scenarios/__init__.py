"""Named events in time: engine start and stop, pedal, clutch, shift, stall, loss of traction, a pulse at idle."""

from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan

__all__ = ["Plan", "planned"]
