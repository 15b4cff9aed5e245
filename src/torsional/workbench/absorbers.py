"""The absorbers that could stand in the place of a model's own."""

from __future__ import annotations

from typing import Any

from torsional.errors import ModelError
from torsional.files.scaling import scaled_absorber
from torsional.model import Model
from torsional.studies.concepts import Scale, absorbers


def choices(model: Model) -> list[tuple[str, str, dict[str, Any]]]:
    """Name, title and block of each shipped absorber, scaled to the model where its engine tells how.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_smf.yaml")
    >>> [name for name, _, _ in choices(truck)][:3]
    ['smf', 'dmf', 'psva']
    """
    factors = _factors(model)
    told = absorbers().items()
    return [
        (name, title.partition(" ")[2], scaled_absorber(block, factors) if factors else block)
        for name, (title, block) in told
    ]


def _factors(model: Model) -> dict[str, float]:
    """By quantity; none where the model is as large as the shipped one, whose figures then stay as they are written."""
    try:
        scale = Scale.of(model)
    except ModelError:
        return {}
    return {} if abs(scale.torque - 1) + abs(scale.idle - 1) + abs(scale.order - 1) < 1e-6 else scale.factors
