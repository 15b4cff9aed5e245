"""A spring law of one's own in the shipped truck: its statics, its tangent and small vibrations about it."""

from dataclasses import dataclass

import numba
import numpy as np

import torsional as tv
from torsional.laws import plain


@numba.njit(error_model="numpy")
def hardening_torque(parameters, angle, rate, memory, step):
    """Torque with its derivatives by angle and rate."""
    scale, bend = parameters
    return plain(scale * np.sinh(angle / bend), scale / bend * np.cosh(angle / bend), 0.0)


@dataclass(frozen=True)
class Hardening(tv.Law):
    """T = scale sinh(φ/bend): scale/bend [Nm/rad] at rest, and ever stiffer."""

    scale: float
    bend: float
    kernel = hardening_torque

    @property
    def parameters(self) -> list[float]:
        return [self.scale, self.bend]


def main() -> dict[str, float]:
    springs = Hardening(scale=1000.0, bend=0.1)
    assert springs.slope_error(np.linspace(-0.3, 0.3, 61)) < 1e-8  # the derivatives are those of the torque
    truck = tv.load_model("examples/truck_dmf.yaml").replaced("dmf", law=springs)
    system, point = tv.at_operating_point(truck, torque=1500.0)
    at = point.names.index("dmf")
    print(f"at 1500 Nm {np.degrees(point.angle[at]):.2f}°, tangent {point.stiffness[at] / 1e3:.2f} kNm/rad")
    # sinh turned about; and cosh² = 1 + sinh²
    assert np.isclose(point.angle[at], 0.1 * np.arcsinh(1.5), rtol=1e-9)
    assert np.isclose(point.stiffness[at], 1e4 * np.sqrt(1 + 1.5**2), rtol=1e-9)

    speed = np.array([600.0, 1200.0]) * tv.RPM  # small swings see the tangent; large ones: tv.model_response
    torque = truck.engine.excitation(truck.landmarks.throws, speed, 1500.0, orders=[3.0])
    swing = abs(tv.harmonic_response(system, torque).torque.sel(element="dmf", order=3.0)).values / point.stiffness[at]
    print(f"order 3 swings it by {np.degrees(swing[0]):.2f}° at 600 rpm and {np.degrees(swing[1]):.2f}° at 1200 rpm")
    return {"twist": float(point.angle[at])}


if __name__ == "__main__":
    main()
