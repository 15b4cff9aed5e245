"""Engine excitation: slider-crank, cylinder pressure, firing, torque harmonics by throw."""

from torsional.engine.combustion import CombustionCycle, LoadTable, Wiebe
from torsional.engine.crankshaft import CrankLayout
from torsional.engine.cylinder import Cylinder
from torsional.engine.engine import Engine
from torsional.engine.excitation import Excitation
from torsional.engine.friction import ChenFlynn
from torsional.engine.full_load import FullLoad
from torsional.engine.gas import GasSource, PressureShapes
from torsional.engine.loading import MeanTorque, OperatingPoints
from torsional.engine.pressure import PressureTrace
from torsional.engine.slider_crank import SliderCrank

__all__ = [
    "ChenFlynn",
    "CombustionCycle",
    "CrankLayout",
    "Cylinder",
    "Engine",
    "Excitation",
    "FullLoad",
    "GasSource",
    "LoadTable",
    "MeanTorque",
    "OperatingPoints",
    "PressureShapes",
    "PressureTrace",
    "SliderCrank",
    "Wiebe",
]
