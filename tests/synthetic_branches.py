"""Branches of periodic motions in closed form, in the shape in which the periodic solver gives them.

Over the speed v [rad/s]: a main branch whose third order falls from 400 Nm, unstable between 90 and 110; there a
doubled branch whose order 1.5 is 60 √((v − 90)(110 − v)) Nm; an isolated one along v = 130 + 10 (s³ − s) with an
order of 600 + 100 s Nm, unstable between its folds at s = ±1/√3.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.results import dataset

ORDERS = np.array([0.0, 1.5, 3.0])
MEAN = 1000.0
STIFFNESS = 1e4
FOLD = 10 * 2 / (3 * np.sqrt(3))
KINDS = ["main", "period doubling", "isolated"]
BIFURCATIONS = [
    ("period doubling", 90.0, 0),
    ("period doubling", 110.0, 0),
    ("fold", 130 + FOLD, 2),
    ("fold", 130 - FOLD, 2),
]


def branches() -> xr.Dataset:
    """The three branches with one spring, one clutch and two nodes."""
    main, doubled, s = np.linspace(50.0, 150.0, 51), np.linspace(90.0, 110.0, 21), np.linspace(-1.4, 1.4, 57)
    speed = np.concatenate([main, doubled, 130 + 10 * (s**3 - s)])
    number = np.repeat([0, 1, 2], [len(main), len(doubled), len(s)])
    stable = np.concatenate([(main <= 90) | (main >= 110), np.full(len(doubled), True), np.abs(s) > 1 / np.sqrt(3)])
    half = np.where(number == 1, 60 * np.sqrt(np.clip((speed - 90) * (110 - speed), 0, None)), 0.0)
    third = np.concatenate([400 - 2 * (main - 50), 300 + 0 * doubled, 600 + 100 * s])
    orders = np.stack([np.full(len(speed), MEAN), half * 1j, third * np.exp(-0.5j)], axis=1)
    torque = orders[:, :, None] * np.array([1.0, 0.5])
    kinds, values, on = zip(*BIFURCATIONS, strict=True)
    count = len(speed)
    told = ("point", "order", "element")
    return dataset(
        {
            "twist": (told, torque / STIFFNESS, "relative_angle"),
            "torque": (told, torque, "torque"),
            "angle": (("point", "order", "node"), torque / 1e5, "angle"),
            "stable": (("point",), stable, ""),
            "multiplier": (("point", "multiplier"), np.where(stable, 0.9, -1.2)[:, None] + 0j, ""),
            "residual": (("point",), np.full(count, 1e-13), ""),
            "kind": (("branches",), np.array(KINDS), ""),
            "base_order": (("branches",), np.array([3.0, 1.5, 3.0]), "engine_order"),
            "parent": (("branches",), np.array([-1, 0, -1]), ""),
            "started": (
                ("branches",),
                np.array(["started at an end of the range", "left branch 0", "found apart"]),
                "",
            ),
            "ended": (("branches",), np.array(["end of the range", "joined the branch it left", "step too small"]), ""),
            "bifurcation_type": (("bifurcation",), np.array(kinds), ""),
            "bifurcation_speed": (("bifurcation",), np.array(values), "speed"),
            "bifurcation_mean_torque": (("bifurcation",), np.full(len(values), MEAN), "torque"),
            "bifurcation_value": (("bifurcation",), np.array(values), "speed"),
            "on_branch": (("bifurcation",), np.array(on), ""),
        },
        {
            "point": (np.arange(count), ""),
            "order": (ORDERS, "engine_order"),
            "element": (np.array(["dmf", "clutch"]), ""),
            "node": (np.array(["crankshaft", "input"]), ""),
            "speed": (speed, "speed", "point"),
            "mean_torque": (np.full(count, MEAN), "torque", "point"),
            "value": (speed, "speed", "point"),
            "branch": (number, "", "point"),
        },
        analysis="periodic response",
        model="in closed form",
        amplitude="complex 0-peak",
        parameter="speed",
        parameter_unit="rad/s",
        main_order=3.0,
    )


def region() -> xr.Dataset:
    """A round region about 95 rad/s and 1100 Nm, with a boundary of period doublings and a piece of a fold."""
    speed, torque = np.linspace(60.0, 130.0, 29), np.linspace(700.0, 1500.0, 17)
    inside = 1 - ((speed - 95) / 20) ** 2 - ((torque[:, None] - 1100) / 200) ** 2
    size = 500 * np.sqrt(np.clip(inside, 0, None))
    turn = np.linspace(0, 2 * np.pi, 41)
    kinds = np.where(turn < np.pi / 2, "fold", "period doubling")
    over = ("mean_torque", "speed")
    return dataset(
        {
            "amplitude": (over, size, "torque"),
            "twist_amplitude": (over, size / STIFFNESS, "relative_angle"),
            "acceleration": (over, 0.4 * size, "acceleration"),
            "stable_solutions": (over, 1 + ((size > 0) & (speed < 80)), ""),
            "boundary_speed": (("boundary_point",), 95 + 20 * np.cos(turn), "speed"),
            "boundary_mean_torque": (("boundary_point",), 1100 + 200 * np.sin(turn), "torque"),
            "boundary_kind": (("boundary_point",), kinds, ""),
            "boundary_curve": (("boundary_point",), np.zeros(len(turn), dtype=int), ""),
        },
        {"mean_torque": (torque, "torque"), "speed": (speed, "speed")},
        analysis="sub-harmonic map",
        order=1.5,
        element="dmf",
        node="input",
        model="in closed form",
    )
