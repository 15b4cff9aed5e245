"""Curves over one swept parameter, told so that `torsional.plots.plot_sweep` can draw them: the pictures of studies.

A variable says in its attributes what its curve is called (``words``), in which panel it stands and what that shows
(``panel``), by which convention amplitudes are told (``amplitude``) and which ``limit`` the judgement turns on
(``limit_words``); the coordinate what is varied (``words``) and on which ``scale`` (``inverse``: what one over it is
called); the Dataset the model's operating
``speed_range``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.model import Model
from torsional.results import labelled


@dataclass(frozen=True, eq=False)
class Curve:
    """Values of a quantity in SI; what they are called; the panel they stand in, by what its axis says; a limit there.

    ``points``: asked at single places only, so not joined by a line; ``like``: the curve of the panel whose colour they
    bear; ``scale``: "log" or nothing.  Not a number is left out; infinite is told as lying beyond the picture.
    """

    values: ArrayLike
    quantity: str
    words: str = ""
    panel: str = ""
    amplitude: str = ""
    limit: float | tuple[float, ...] | None = None
    limit_words: str = ""
    points: bool = False
    scale: str = ""
    like: str = ""

    @property
    def told(self) -> dict[str, object]:
        """What the picture must know, as attributes."""
        every = {name: getattr(self, name) for name in ("words", "panel", "amplitude", "limit_words", "scale", "like")}
        found: dict[str, object] = {name: text for name, text in every.items() if text}
        found |= {} if self.limit is None else {"limit": np.asarray(self.limit, dtype=float).tolist()}
        return found | ({"points": 1} if self.points else {})


@dataclass(frozen=True, eq=False)
class Along:
    """What is varied: a coordinate by name, its values in SI (or names), their quantity, in words; ``scale`` "log";
    what its ``inverse`` is called, if that is told too."""

    name: str
    values: ArrayLike
    quantity: str = ""
    words: str = ""
    scale: str = ""
    inverse: str = ""

    @property
    def told(self) -> dict[str, str]:
        """What the picture must know, as attributes."""
        return {name: text for name in ("words", "scale", "inverse") if (text := getattr(self, name))}


def swept(id: str, along: Along, curves: Mapping[str, Curve], model: Model | None = None) -> xr.Dataset:
    """Curves over one parameter; the ``model``'s operating range is told beside them.

    >>> found = swept("X1", Along("gear", ["1", "2"]), {"top": Curve([60.0, 70.0], "speed", limit=80.0)})
    >>> found.top.attrs["units"], found.top.attrs["limit"], found.gear.values.tolist()
    ('rad/s', 80.0, ['1', '2'])
    """
    told = {name: ((along.name,), np.asarray(curve.values), curve.quantity) for name, curve in curves.items()}
    known = {} if model is None else {"model": model.name, "speed_range": json.dumps(list(model.operation.speed))}
    data = labelled(told, {along.name: (np.asarray(along.values), along.quantity)}, analysis=f"claim {id}", **known)
    for name, curve in curves.items():
        data[name].attrs.update(curve.told)
    data[along.name].attrs.update(along.told)
    return data


def over_speed(speed: ArrayLike) -> Along:
    """Engine speed [rad/s] as what is varied."""
    return Along("speed", speed, "speed", "engine speed")


def over_gears(model: Model) -> Along:
    """The gears of a model as what is varied."""
    return Along("gear", np.array(model.gear_names))
