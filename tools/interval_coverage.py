"""How often the intervals of an identification hold the truth: claim F1's loops measured again, with other noise.

    python tools/interval_coverage.py 100

prints in how many draws each parameter's 95 % interval holds its true value, with the encoder's noise in the covariance
and without.  Fits begin three standard deviations about the truth, as a search from afar leaves them.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Iterator

import numpy as np

from torsional.studies.claims.identification import POINTS, SENSORS, TRUTH, greased, rig_flywheel, unknowns
from torsional.studies.estimates import Identified
from torsional.studies.identify import appraised, refined
from torsional.studies.loop_torques import ANGLE_OFFSET, TORQUE_OFFSET, torques_in
from torsional.studies.rig import ROUGH_STEPS, course, met, sensed, torques_of

TRUE = {**TRUTH, TORQUE_OFFSET: SENSORS.torque_offset, ANGLE_OFFSET: SENSORS.angle_offset}


def draws(first: int, count: int) -> Iterator[Identified]:
    """What is found in loops of different noise, by seeds from ``first`` on."""
    design = rig_flywheel()
    courses = [course(design, point) for point in POINTS]
    torques = [loop.torque for loop in met(design, courses)]
    begun = [dataclasses.replace(each, start=TRUE[name]) for name, each in unknowns().items()]
    for seed in range(first, first + count):
        loops = sensed(POINTS, courses, torques, SENSORS, seed)
        told, fine = torques_in(loops), torques_of(greased, loops)
        near = appraised(torques_of(greased, loops, ROUGH_STEPS), told, begun)
        off = 3.0 * near.deviations * np.random.default_rng(seed).standard_normal(len(begun))
        near = dataclasses.replace(near, estimates=near.estimates + off)
        yield refined(fine.extrapolated, told, near, errors=fine.errors, rough=fine)


def held(found: Identified) -> np.ndarray:
    """Whether each parameter's interval holds the truth."""
    low, high = found.intervals().T
    true = np.array([TRUE[unknown.name] for unknown in found.unknowns])
    return np.asarray((low <= true) & (true <= high))


def main() -> None:
    """Count them."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("draws", type=int, nargs="?", default=100)
    asked.add_argument("--first", type=int, default=1000, help="seed of the first draw")
    given = asked.parse_args()
    told = np.zeros((2, len(TRUE)), dtype=int)
    for number, found in enumerate(draws(given.first, given.draws), 1):
        told += np.array([held(found), held(dataclasses.replace(found, inputs=()))])
        print(f"{number} draws: with the encoder's noise {told[0].tolist()}, without {told[1].tolist()}", flush=True)
    for place, unknown in enumerate(TRUE):
        print(f"{unknown:32} {told[0, place]:4d} of {given.draws}, without the encoder's noise {told[1, place]:4d}")


if __name__ == "__main__":
    main()
