"""A rubber coupling by a law of one's own: its resonance bends over, and has two stable motions at one speed."""

from dataclasses import dataclass

import numba
import numpy as np

import torsional as tv
from torsional.laws import plain


@numba.njit(error_model="numpy")
def rubber_torque(parameters, angle, rate, memory, step):
    """Torque with its derivatives by angle and rate; nothing is remembered."""
    k, k3, c = parameters
    return plain(k * angle + k3 * angle**3 + c * rate, k + 3 * k3 * angle**2, c)


@dataclass(frozen=True)
class Rubber(tv.Law):
    """k φ + k3 φ³ + c φ̇."""

    stiffness: float
    hardening: float
    damping: float
    kernel = rubber_torque

    @property
    def parameters(self) -> np.ndarray:
        return np.array([self.stiffness, self.hardening, self.damping])


def main() -> dict[str, float]:
    # in units of its linear frequency: x'' + 0.05 x' + x + 0.1 x³ = 0.18 cos Ωt
    coupling = tv.Coupling("ground", "disc", Rubber(1.0, 0.1, 0.05))
    system = tv.assemble(tv.Powertrain({"disc": tv.Inertia(1.0), "coupling": coupling}))
    found = tv.periodic_response(system, tv.Excitation(("disc",), [1], 1.0, [[0.18]]), (0.5, 2.0), highest_order=7)
    folds = found.isel(point=np.flatnonzero(found.event.values == "fold"))
    order = np.argsort(folds.speed.values)
    speed = folds.speed.values[order]
    size = abs(folds.twist.sel(element="coupling", order=1)).values[order]
    print(f"run up, it falls from {size[1]:.3f} rad at {speed[1]:.4f} rad/s; run down, it jumps up at {speed[0]:.4f}")
    return {"run down": float(speed[0]), "run up": float(speed[1]), "at the fall": float(size[1])}


if __name__ == "__main__":
    main()
