"""The absorber block: what stands between crankshaft and clutch, one concept a module.

Every module here is found by itself: a new concept is a new module with a class of `AbsorberBlock`.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.making import choice

for _module in iter_modules(__path__, f"{__name__}."):
    import_module(_module.name)

if TYPE_CHECKING:
    AnyAbsorber = AbsorberBlock
else:
    AnyAbsorber = choice(AbsorberBlock)

__all__ = ["AbsorberBlock", "AnyAbsorber"]
