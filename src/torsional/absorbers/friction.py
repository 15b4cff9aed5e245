"""Friction beside an absorber's springs."""

from __future__ import annotations

from torsional.absorbers.base import Absorber
from torsional.arguments import checked
from torsional.components import Coupling
from torsional.errors import ModelError
from torsional.laws import Law


@checked
def with_friction(absorber: Absorber, law: Law) -> Absorber:
    """Any absorber of one row of springs with a friction ``law`` beside them, named after them: ``dmf_friction``.

    The law [Nm] is one of `torsional.laws`, `Jenkins` for a washer.

    Raises ModelError for an absorber without springs or with two rows.

    >>> from torsional.absorbers.dual_mass import dual_mass_flywheel
    >>> from torsional.laws import Hinges, Jenkins
    >>> absorber = with_friction(dual_mass_flywheel(1.2, 1.0, Hinges(13e3)), Jenkins(80.0, 4e4))
    >>> absorber.components["dmf_friction"].law.limit_torque
    80.0
    """
    springs = [absorber.components[name] for name in absorber.springs]
    if len(springs) != 1 or not isinstance(springs[0], Coupling):
        found = ", ".join(absorber.springs) or "no springs"
        raise ModelError("friction stands beside one row of springs", found=found, remedy="add a Coupling of its own")
    return absorber.joined({f"{absorber.springs[0]}_friction": Coupling(springs[0].a, springs[0].b, law)})
