"""Motion in time: a system and what drives it as arrays, stepped."""

from torsional.solvers.transient.certificate import Certificate, certified
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.solvers.transient.drives import Governor, OrderTorques, TorqueHistory
from torsional.solvers.transient.events import stage_changes
from torsional.solvers.transient.orders import crank_angle_of, order_tracking, windowed_rms
from torsional.solvers.transient.run import transient
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import MotionState
from torsional.solvers.transient.steady import steady_state
from torsional.solvers.transient.sweeps import engine_drive, steady_map, steady_sweep

__all__ = [
    "Certificate",
    "CylinderTorques",
    "Governor",
    "MotionState",
    "OrderTorques",
    "SpeedProfile",
    "TorqueHistory",
    "certified",
    "crank_angle_of",
    "engine_drive",
    "order_tracking",
    "stage_changes",
    "steady_map",
    "steady_state",
    "steady_sweep",
    "transient",
    "windowed_rms",
]
