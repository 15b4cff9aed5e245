"""Torsional vibrations of vehicle powertrains and the absorbers that tame them.

Names are imported when they are first used, so that ``import torsional`` costs next to nothing; ``__init__.pyi`` lists
them.
"""

from __future__ import annotations

import lazy_loader

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
