"""Single mass flywheel."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from torsional.absorbers import single_mass_flywheel
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.fields import Inertia


class SingleMassFlywheel(AbsorberBlock):
    """A rigid flywheel."""

    makes: ClassVar = single_mass_flywheel
    type: Literal["single_mass_flywheel"]
    inertia: Inertia = Field(description="flywheel with clutch cover")
