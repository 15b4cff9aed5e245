"""Force laws: each is data plus one scalar compiled function that every solver calls.

A law's ``kernel`` is a compiled function of plain floats::

    torque(parameters, angle, rate, memory, step)
        -> (torque, d_angle, d_rate, d_memory, memory, m_angle, m_rate, m_memory)

It tells the state at the end of a ``step`` [s] during which the relative rate was ``rate`` [rad/s]: the torque [Nm],
its derivatives by angle, rate and old memory, the new memory and its derivatives by the same.  A law without memory
looks at neither memory nor step and gives back `plain`.  The memory is the elastic deflection [rad] of the element
that sticks or slides, zero when relaxed.  With a step of zero nothing moves: the torque is that of the given memory,
and by agreement the derivatives by the angle are those of sticking, which is what linear analyses ask for.

The Python object holds the named, checked values, packs them into ``parameters`` and broadcasts the same function over
arrays; other compiled code finds it at the law's ``address``.  A law of one's own is a subclass of `Law` with a
``kernel`` and ``parameters``; no solver changes.
"""

from torsional.laws.base import Law, Told, hinge_rows, plain
from torsional.laws.contacts import Contacts, contact_time
from torsional.laws.friction import Coulomb, Jenkins
from torsional.laws.hinges import Hinges
from torsional.laws.karnopp import Karnopp
from torsional.laws.loops import Loop, hysteresis_loop
from torsional.laws.lugre import LuGre
from torsional.laws.packing import PackedLaws, packed
from torsional.laws.rows import HingeRows
from torsional.laws.smooth import Polynomial, Table
from torsional.laws.stribeck import Stribeck

__all__ = [
    "Contacts",
    "Coulomb",
    "HingeRows",
    "Hinges",
    "Jenkins",
    "Karnopp",
    "Law",
    "Loop",
    "LuGre",
    "PackedLaws",
    "Polynomial",
    "Stribeck",
    "Table",
    "Told",
    "contact_time",
    "hinge_rows",
    "hysteresis_loop",
    "packed",
    "plain",
]
