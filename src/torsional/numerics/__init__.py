"""Pure mathematics: no mechanics here."""

from pathlib import Path

from torsional.numerics.outdated import discard_outdated

discard_outdated(Path(__file__).parent.parent)
