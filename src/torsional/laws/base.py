"""What every force law is: values, and one scalar compiled function of them."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, ClassVar, Self, cast

import numba
import numpy as np
from numba.extending import register_jitable
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.laws.inversion import inverted
from torsional.laws.rows import HingeRows
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import RETURNED, address_of, law_at
from torsional.units import quoted

Told = tuple[float, float, float, float, float, float, float, float]
"""Torque and its derivatives by angle, rate and memory; the new memory and its derivatives by the same."""

_WANTED = "write a property `parameters` that returns the values in the order in which the kernel reads them"
_FEW = 2000
"""Evaluations up to which plain Python is quicker than getting hold of compiled code."""


@register_jitable  # callable from compiled code and from Python, where a compiled function would first be compiled
def plain(torque: float, d_angle: float, d_rate: float) -> Told:
    """What the kernel of a law without memory gives back, from its torque and the derivatives by angle and rate.

    >>> plain(3.0, 2.0, 0.0)
    (3.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """
    return torque, d_angle, d_rate, 0.0, 0.0, 0.0, 0.0, 0.0


@register_jitable
def _rows(
    torque: Callable[..., Told], parameters: Array, angle: Array, rate: Array, memory: Array, step: Array
) -> Array:
    out = np.empty((RETURNED, angle.size))
    for i in range(angle.size):
        told = torque(parameters, angle[i], rate[i], memory[i], step[i])
        for j in range(RETURNED):
            out[j, i] = told[j]
    return out


@register_jitable
def _marched(torque: Callable[..., Told], parameters: Array, angle: Array, step: Array, memory: float) -> Array:
    out = np.empty((2, angle.size))
    for i in range(angle.size):
        rate = (angle[i] - angle[i - 1]) / step[i] if i > 0 else 0.0
        told = torque(parameters, angle[i], rate, memory, step[i])
        memory = told[4]
        out[0, i], out[1, i] = told[0], memory
    return out


@numba.njit(cache=True)
def _compiled_rows(address: int, parameters: Array, angle: Array, rate: Array, memory: Array, step: Array) -> Array:
    return _rows(law_at(address), parameters, angle, rate, memory, step)


@numba.njit(cache=True)
def _compiled_march(address: int, parameters: Array, angle: Array, step: Array, memory: float) -> Array:
    return _marched(law_at(address), parameters, angle, step, memory)


class Law:
    """A torque law along one relative angle; subclasses give ``kernel`` and ``parameters``.

    ``remembers``: the torque depends on the past as well, through one number, the elastic deflection [rad] of the
    element that sticks or slides; zero is relaxed.  ``carries_mean_torque``: it holds a torque at rest.
    """

    kernel: ClassVar[Callable[..., Told]]
    flow: ClassVar[Callable[..., Told] | None] = None
    """A kernel whose first number is the rate of the memory, for integrators that take it for a state."""
    remembers: ClassVar[bool] = False
    carries_mean_torque: ClassVar[bool] = True
    departs: ClassVar[str] = "swings across a change of its stiffness, where the linear response is an approximation"
    """What it means that the law `changes_within` a swing, in words that follow the connection's name."""
    load_place: ClassVar[int] = -1
    """Place of the normal load among the parameters, of a law whose torque grows with one; −1 of any other."""
    stops: tuple[float, ...] = ()
    """Angles [rad] that are end stops."""

    @property
    def parameters(self) -> Array:
        """The law's values as one flat array, in the order its kernel reads them."""
        raise ModelError("a law's parameters are missing", where=type(self).__name__, remedy=_WANTED)

    @property
    def unguarded_stiffness(self) -> float:
        """Stiffness [Nm/rad] of the stiffest contact whose damper is of a kind that no time step can raise; else 0."""
        return 0.0

    @property
    def label(self) -> str:
        """What a picture writes beside a law that its stages do not describe; empty of most."""
        return ""

    @property
    def packed(self) -> Array:
        """The parameters as kernels read them, whatever sequence of numbers a law gives; ModelError for none such."""
        values: object = self.parameters
        try:
            row = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            row = np.zeros(())
        if row.ndim != 1:
            name = f"{type(self).__name__}.parameters"
            raise ModelError("a row of numbers is wanted", where=name, found=quoted(values), remedy=_WANTED)
        return np.ascontiguousarray(row)

    @property
    def address(self) -> int:
        """Where the compiled kernel is, for `torsional.numerics.callbacks.law_at`; compiled or read from disk once."""
        return address_of(type(self).kernel)

    def hinges(self) -> HingeRows | None:
        """The law as a spring and hinges, where it is a sum of them; None where it is not."""
        return None

    @property
    def straight(self) -> HingeRows | None:
        """The hinges of a law that is straight lines over the angle; None of any other, and where contacts have times.

        Its spectra, its motion between two crossings and the stages it has are known in closed form.
        """
        rows = self.hinges()
        return None if rows is None or rows.contact_time.any() else rows

    @property
    def edges(self) -> Array:
        """Angles [rad] at which the slope changes, from left to right; none of a smooth law."""
        return np.zeros(0)

    @property
    def transitions(self) -> tuple[float, ...]:
        """Angles [rad] at which another stage begins: the edges that are no stops."""
        return tuple(edge for edge in self.edges.tolist() if edge not in self.stops)

    @property
    def nearest_edge(self) -> float:
        """The way [rad] from rest to the nearest edge on either side, one at rest not counted; zero where none is."""
        away = np.abs(self.edges)
        return float(away[away > 0].min()) if away.any() else 0.0

    @property
    def slopes(self) -> Array:
        """Slopes [Nm/rad] between the edges, from left to right; of a law without edges that at rest."""
        edges = self.edges
        if not edges.size:
            return self.tangent(np.zeros(1))
        return self.tangent(np.concatenate([[edges[0] - 1.0], 0.5 * (edges[1:] + edges[:-1]), [edges[-1] + 1.0]]))

    def stage(self, angle: ArrayLike) -> IntArray:
        """Number of the segment that an angle [rad] lies in: 0 holds the angle zero, ±1 the next on either side."""
        edges = self.edges
        middle = np.searchsorted(edges, 0.0)
        return np.asarray(np.searchsorted(edges, np.asarray(angle, dtype=float)) - middle, dtype=np.int64)

    @property
    def flow_address(self) -> int:
        """Where the compiled rate of the memory is; zero of a law whose memory has none."""
        return address_of(type(self).flow) if type(self).flow is not None else 0

    def evaluate(
        self, angle: ArrayLike, rate: ArrayLike = 0.0, memory: ArrayLike = 0.0, step: ArrayLike = 0.0
    ) -> tuple[Array, ...]:
        """Torque [Nm], its derivatives by angle and rate, and the new memory, broadcast over the arguments.

        ``step`` [s] is how long the ``rate`` [rad/s] has acted since the ``memory`` [rad]; see the kernel's meaning.
        """
        arrays = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (angle, rate, memory, step)))
        flat = [np.ascontiguousarray(np.ravel(v)) for v in arrays]
        out = self._run(_rows, _compiled_rows, arrays[0].size, *flat)
        return tuple(row.reshape(arrays[0].shape) for row in (out[0], out[1], out[2], out[4]))

    def march(self, angle: ArrayLike, step: ArrayLike, memory: float = 0.0) -> tuple[Array, Array]:
        """Torque [Nm] and memory [rad] along a history of the ``angle`` [rad], sampled every ``step`` [s].

        ``step`` is one number, or for each angle the time since the one before.  The history starts at rest with
        ``memory``; over each step the rate is the mean one.  A hysteresis loop is the torque over the angle.
        """
        angles = np.ascontiguousarray(angle, dtype=float)
        steps = np.array(np.broadcast_to(np.asarray(step, dtype=float), angles.shape))
        steps[:1] = 0.0
        torque, memories = self._run(_marched, _compiled_march, angles.size, angles, steps, float(memory))
        return torque, memories

    def loaded(self, load: float) -> Self:
        """The same law under a normal ``load`` [N]; raises ModelError where it has none.

        >>> from torsional.laws import LuGre
        >>> LuGre(1e5, 300.0, 1.0, 1.5, 0.001).loaded(20.0).normal_load
        20.0
        """
        if self.load_place < 0 or not hasattr(self, "normal_load"):
            raise ModelError("this law has no normal load", found=type(self).__name__)
        law: Any = self
        return cast("Self", dataclasses.replace(law, normal_load=float(load)))

    def refuse_unfinished(self) -> None:
        """ModelError for a law of one's own without a kernel or a row of parameters, before an analysis meets it."""
        _ = self._own_kernel(), self.packed

    def _own_kernel(self) -> Callable[..., Told]:
        if not hasattr(type(self), "kernel"):
            remedy = "write kernel = f, where f is a function under numba.njit that returns torsional.laws.plain(...)"
            raise ModelError("a law's kernel is missing", where=type(self).__name__, remedy=remedy)
        return type(self).kernel

    def _run(self, interpreted: Any, compiled: Any, size: int, *arguments: Any) -> Array:
        """One of two functions of the same body: for a few evaluations in Python, else by the kernel's address."""
        kernel = self._own_kernel()
        if size >= _FEW and hasattr(kernel, "py_func"):
            return np.asarray(compiled(self.address, self.packed, *arguments))
        try:
            with np.errstate(over="ignore"):
                return np.asarray(interpreted(getattr(kernel, "py_func", kernel), self.packed, *arguments))
        except (IndexError, TypeError):
            _ = self.address  # where the kernel is none, this says what one is
            raise

    def torque(self, angle: ArrayLike, rate: ArrayLike = 0.0) -> Array:
        """Torque [Nm] at a relative angle [rad] and rate [rad/s]."""
        return self.evaluate(angle, rate)[0]

    def tangent(self, angle: ArrayLike) -> Array:
        """Slope of the torque [Nm/rad] at an angle [rad]."""
        return self.evaluate(angle)[1]

    def angle(self, torque: ArrayLike, beside: float = 0.0) -> Array:
        """The angle [rad] at which a rising law, and a stiffness ``beside`` it [Nm/rad], carry a torque [Nm] at rest.

        Raises ModelError where none is found.
        """
        torque = np.asarray(torque, dtype=float)

        def left(angle: Array) -> tuple[Array, Array]:
            force, slope = self.evaluate(angle)[:2]
            return torque - beside * angle - force, beside + slope

        return inverted(left, torque)

    def slope_error(self, angle: ArrayLike, rate: ArrayLike = 0.0) -> float:
        """Largest difference [-] of the slopes that the kernel tells from those of its torque, over the largest slope.

        A check for laws of one's own, whose wrong derivatives nothing else would tell: about 1e-9 where they are right.
        Central differences at ``angle`` [rad] and ``rate`` [rad/s], away from kinks, of a law without memory.
        """
        angle, rate = np.broadcast_arrays(np.asarray(angle, dtype=float), np.asarray(rate, dtype=float))
        told = self.evaluate(angle, rate)[1:3]
        wide, fast = (1e-5 * (np.abs(v).max() or 1.0) for v in (angle, rate))
        found = (
            (self.torque(angle + wide, rate) - self.torque(angle - wide, rate)) / (2 * wide),
            (self.torque(angle, rate + fast) - self.torque(angle, rate - fast)) / (2 * fast),
        )
        off = [np.abs(a - b).max() / (np.abs(b).max() or 1.0) for a, b in zip(told, found, strict=True)]
        return float(max(off))

    def stage_name(self, angle: float) -> str:
        """The part of the law that an angle [rad] lies in, in words; a law without parts is smooth."""
        return "smooth"

    def distance_to_stop(self, angle: float, torque: float) -> float:
        """The way [rad] left to the end stop on the side of the torque; not a number where there is none."""
        return float("nan")

    def changes_within(self, low: ArrayLike, high: ArrayLike) -> Array:
        """Whether a swing between two angles [rad] crosses an edge: a linear response is no more than an approximation.

        >>> from torsional.laws import Hinges
        >>> Hinges.staged([(100.0, 1e3), (300.0, 4e3)]).changes_within([0.0, 0.05], [0.09, 0.15]).tolist()
        [False, True]
        """
        low, high = np.broadcast_arrays(np.asarray(low, dtype=float), np.asarray(high, dtype=float))
        edges = self.edges
        return np.asarray(((low[..., None] < edges) & (edges < high[..., None])).any(axis=-1))

    def secant(self, centre: ArrayLike, amplitude: ArrayLike) -> Array:
        """Stiffness of the chord [Nm/rad] across ``centre ± amplitude`` [rad]."""
        centre, amplitude = np.asarray(centre, dtype=float), np.asarray(amplitude, dtype=float)
        return np.asarray((self.torque(centre + amplitude) - self.torque(centre - amplitude)) / (2 * amplitude))


def hinge_rows(law: Law | None) -> HingeRows | None:
    """The `Law.hinges` of a connection's law, which is None where the connection is linear.

    >>> from torsional.laws import Contacts
    >>> hinge_rows(Contacts.lash(0.02, 1e5)).change.tolist()
    [100000.0, 100000.0]
    """
    return None if law is None else law.hinges()
