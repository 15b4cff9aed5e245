"""The nomenclature: every kind of value of the project with its symbol, its unit and the name engineers give it.

A *kind* ("torque", "stiffness") says which units may be written; several quantities share a kind.  The rough range is
that of road vehicles' powertrains and serves warnings only.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Quantity:
    """One line of the nomenclature.

    ``unit`` is the SI unit in which every value is kept, ``shown`` the unit in which faces write it, ``low`` and
    ``high`` [``unit``] bound the magnitudes that raise no eyebrow.

    >>> QUANTITIES["stiffness"].symbol, QUANTITIES["stiffness"].unit
    ('k', 'Nm/rad')
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    kind: str
    shown: str
    low: float = 0.0
    high: float = float("inf")


_TABLE = (
    Quantity("angle", "θ", "rad", "angle of a node", "angle", "deg", 0.0, 7.0),
    Quantity("relative_angle", "φ", "rad", "angle of b relative to a", "angle", "deg", 0.0, 7.0),
    Quantity("crank_angle", "α", "rad", "crank angle after top dead centre", "angle", "deg", 0.0, 26.0),
    Quantity("speed", "Ω", "rad/s", "mean engine speed", "angular velocity", "rpm", 5.0, 800.0),
    Quantity("angular_velocity", "ω", "rad/s", "angular velocity of a node", "angular velocity", "rpm", 0.0, 2000.0),
    Quantity("angular_frequency", "ω", "rad/s", "angular frequency", "angular velocity", "rad/s", 0.0, 2e4),
    Quantity("acceleration", "θ̈", "rad/s²", "acceleration of a node", "angular acceleration", "rad/s²", 0.0, 1e5),
    Quantity("torque", "T", "Nm", "torque", "torque", "Nm", 0.5, 1e5),
    Quantity("stiffness", "k", "Nm/rad", "torsional stiffness", "stiffness", "kNm/rad", 50.0, 5e7),
    Quantity("damping", "c", "Nm s/rad", "viscous torsional damping", "damping", "Nm s/rad", 1e-3, 2e4),
    Quantity("inertia", "J", "kgm²", "moment of inertia", "inertia", "kgm²", 1e-4, 2e4),
    Quantity("loss_factor", "η", "-", "loss factor of a stiffness", "number", "-", 0.0, 2.0),
    Quantity("centrifugal_stiffness", "s", "kgm²", "stiffness over speed squared", "pendulum stiffness", "kgm²"),
    Quantity("mass", "m", "kg", "mass", "mass", "kg", 1e-3, 1e5),
    Quantity("length", "l", "m", "length", "length", "mm", 1e-4, 20.0),
    Quantity("presliding", "δ", "m", "elastic way before sliding", "length", "µm", 1e-8, 1e-2),
    Quantity("area", "A", "m²", "area", "area", "cm²", 1e-7, 10.0),
    Quantity("volume", "V", "m³", "volume", "volume", "cm³", 1e-7, 1.0),
    Quantity("density", "ρ", "kg/m³", "density", "density", "kg/m³", 0.1, 2.5e4),
    Quantity("force", "F", "N", "force", "force", "N", 1e-2, 1e7),
    Quantity("spring_rate", "R", "N/m", "stiffness of a coil spring", "spring rate", "N/mm", 100.0, 1e8),
    Quantity("pressure", "p", "Pa", "absolute pressure", "pressure", "bar", 1e3, 5e7),
    Quantity("mean_pressure", "p_m", "Pa", "mean effective pressure", "pressure", "bar", 1e2, 1e7),
    Quantity("shear_modulus", "G", "Pa", "shear modulus", "pressure", "GPa", 1e5, 1e12),
    Quantity("temperature", "ϑ", "K", "absolute temperature", "temperature", "K", 200.0, 4000.0),
    Quantity("frequency", "f", "Hz", "frequency", "frequency", "Hz", 0.0, 1e4),
    Quantity("time", "t", "s", "time", "time", "s", 0.0, 1e5),
    Quantity("velocity", "v", "m/s", "velocity of the vehicle", "velocity", "km/h", 0.0, 100.0),
    Quantity("power", "P", "W", "power", "power", "kW", 0.0, 5e6),
    Quantity("energy", "W", "J", "energy", "energy", "J"),
    Quantity("gear_ratio", "i", "-", "speed of the input over speed of the output", "number", "-", 0.01, 300.0),
    Quantity("engine_order", "n", "-", "cycles per crankshaft revolution", "number", "-", 0.0, 1000.0),
    Quantity("friction_coefficient", "µ", "-", "coefficient of friction", "number", "-", 0.0, 2.0),
    Quantity("damping_ratio", "ζ", "-", "share of critical damping", "number", "-", 0.0, 2.0),
    Quantity("mode_shape", "φ", "-", "mode shape, largest angle one", "number", "-", 0.0, 1.0),
    Quantity("energy_share", "p", "-", "share of a mode's energy", "number", "%", 0.0, 1.0),
    Quantity("eigenvalue", "λ", "1/s", "eigenvalue of a damped mode", "rate", "1/s", 0.0, 1e5),
    Quantity(
        "irregularity", "δ", "-", "cyclic irregularity of speed (peak-to-peak over mean)", "number", "-", 0.0, 1.0
    ),
    Quantity("efficiency", "η", "-", "power out over power in", "number", "%", 0.0, 1.0),
    Quantity("relative_difference", "ε", "-", "difference over the value itself", "number", "%", 0.0, 10.0),
    Quantity("ratio", "r", "-", "ratio of like quantities", "number", "-"),
    Quantity("number", "n", "-", "plain number", "number", "-"),
)

QUANTITIES: Mapping[str, Quantity] = MappingProxyType({quantity.name: quantity for quantity in _TABLE})

_TURN = 2.0 * math.pi
_ANGLE = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "°": math.pi / 180, "rev": _TURN}
_TIME = {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}
_LENGTH = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "µm": 1e-6}
_MASS = {"kg": 1.0, "g": 1e-3, "t": 1e3}
_FORCE = {"N": 1.0, "kN": 1e3, "MN": 1e6}
_TORQUE = {"N·m": 1.0, "kN·m": 1e3, "MN·m": 1e6, "mN·m": 1e-3, "N·cm": 1e-2, "N·mm": 1e-3}
_REVOLVING = {
    **dict.fromkeys(("rpm", "1/min", "min-1", "U/min", "rev/min", "RPM"), _TURN / 60),
    **dict.fromkeys(("rev/s", "Hz"), _TURN),
}


def _per(above: Mapping[str, float], below: Mapping[str, float], power: int = 1) -> dict[str, float]:
    suffix = str(power) if power > 1 else ""
    return {f"{a}/{b}{suffix}": x / y**power for a, x in above.items() for b, y in below.items()}


def _times(first: Mapping[str, float], second: Mapping[str, float], power: int = 1) -> dict[str, float]:
    suffix = str(power) if power > 1 else ""
    return {f"{a}·{b}{suffix}": x * y**power for a, x in first.items() for b, y in second.items()}


def _raised(base: Mapping[str, float], power: int) -> dict[str, float]:
    return {f"{a}{power}": x**power for a, x in base.items()}


_ARC = {name: _ANGLE[name] for name in ("rad", "deg", "°")}
_SHORT = {name: _LENGTH[name] for name in ("m", "cm", "mm")}
_NM = {name: _TORQUE[name] for name in ("N·m", "kN·m", "MN·m")}
_ARC_RATE = {"(rad/s)": 1.0, "(deg/s)": math.pi / 180, "rpm": _TURN / 60}
CANONICAL: dict[str, dict[str, float]] = {
    "number": {"-": 1.0, "%": 1e-2, "‰": 1e-3},
    "angle": _ANGLE | {"°CA": math.pi / 180, "degCA": math.pi / 180},
    "angular velocity": {"rad/s": 1.0} | _REVOLVING | _per(_ARC, {"s": 1.0}),
    "angular acceleration": _per(_ARC, {"s": 1.0}, 2) | {"rpm/s": _TURN / 60, "rev/s2": _TURN},
    "torque": _TORQUE,
    "stiffness": _per(_NM, _ARC),
    "damping": _per(_times(_NM, {"s": 1.0}), _ARC) | _per(_NM, _ARC_RATE),
    "pendulum stiffness": {"kg·m2": 1.0, "N·m·s2/rad": 1.0, "N·m/rad/(rad/s)2": 1.0},
    "inertia": _times(_MASS, _SHORT, 2) | {"N·m·s2": 1.0, "N·m·s2/rad": 1.0},
    "mass": _MASS,
    "length": _LENGTH,
    "area": _raised(_SHORT, 2),
    "volume": _raised(_SHORT, 3) | {"l": 1e-3, "L": 1e-3},
    "density": {"kg/m3": 1.0, "g/cm3": 1e3, "kg/dm3": 1e3, "kg/l": 1e3, "t/m3": 1e3},
    "force": _FORCE,
    "spring rate": _per(_FORCE, {"m": 1.0, "mm": 1e-3}),
    "pressure": {"Pa": 1.0, "hPa": 1e2, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "mbar": 1e2, "bar": 1e5, "N/mm2": 1e6}
    | {"psi": 6894.757293168361},
    "temperature": {"K": 1.0},
    "frequency": {"Hz": 1.0, "kHz": 1e3},
    "rate": {"1/s": 1.0},
    "time": _TIME,
    "velocity": {"m/s": 1.0, "km/h": 1 / 3.6},
    "power": {"W": 1.0, "kW": 1e3, "MW": 1e6, "PS": 735.49875, "hp": 745.6998715822702},
    "energy": {"J": 1.0, "kJ": 1e3, "MJ": 1e6, "kWh": 3.6e6},
}


def _spellings(canonical: str) -> Iterator[str]:
    """Every way to write or leave out the dots: N·m·s is also Nms, Nm·s and N·ms, but never m·m for mm."""
    atoms = canonical.split("·")
    for joints in itertools.product(("", "·"), repeat=len(atoms) - 1):
        yield "".join(itertools.chain(*zip(atoms, (*joints, ""), strict=True)))


UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        kind: MappingProxyType({text: factor for unit, factor in table.items() for text in _spellings(unit)})
        for kind, table in CANONICAL.items()
    }
)
"""Kind of quantity → spelling → factor to SI; the same spelling (Hz) may mean different things for different kinds."""


def pretty(canonical: str) -> str:
    """The unit as it is printed: kN·m·s2/rad is kNm s²/rad.

    >>> pretty("kN·m·s2/rad"), pretty("kg·m2")
    ('kNm s²/rad', 'kgm²')
    """
    spaced = canonical.replace("·s", " s").replace("·", "")
    return re.sub(r"(?<=[a-z)])[23]", lambda digit: {"2": "²", "3": "³"}[digit[0]], spaced)
