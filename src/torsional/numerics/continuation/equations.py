"""Equations given by Python functions, made ready for the continuation: a dense bordered Newton method."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.curves import FOLD, Corrected

BRANCH_POINT = "branch point"
DIFFERENCE_STEP = float(np.finfo(float).eps ** (1.0 / 3.0))


def branch_test(jacobian: Array, tangent: Array) -> float:
    """Test function of simple branch points: zero with a change of sign where two smooth branches cross.

    ``jacobian`` F_z (n, n + 1), ``tangent`` (n + 1,).  The sign of det [F_z; tᵀ] times the smallest over the largest
    singular value of F_z: the determinant itself spans many powers of ten, this is of the order of one at most and
    crosses zero linearly.  A fold leaves it alone.  Source: Allgower and Georg, Introduction to Numerical Continuation
    Methods, SIAM 2003, section 8.1, doi 10.1137/1.9780898719154.

    F = x p at (0, −1) and at (0, 1), along p:

    >>> branch_test(np.array([[-1.0, 0.0]]), np.array([0.0, 1.0]))
    -1.0
    >>> branch_test(np.array([[1.0, 0.0]]), np.array([0.0, 1.0]))
    1.0
    """
    singular = np.linalg.svd(jacobian, compute_uv=False)
    sign = np.linalg.slogdet(np.vstack([jacobian, tangent]))[0]
    return float(sign * singular[-1] / singular[0]) if singular[0] > 0.0 else 0.0


class Equations:
    """F(x, p) = 0 from Python functions: ``residual(x, p)`` of shape (n,), x of shape (n,), p a number.

    ``scale`` (n + 1,) is the usual size of x and, last, of p, which makes the variables of the continuation of the
    order of one.  ``jacobian(x, p)`` of shape (n, n + 1) holds the derivatives by x and, last, by p; without it they
    are taken by central differences.  ``tests`` maps a name to a function (x, p) → float whose changes of sign are
    events; ``branch_points`` adds the test "branch point".  Newton's steps end where the error left is below
    ``tolerance`` of the size of z, or fail after ``most_iterations``.

    Where ``residual`` raises an ArithmeticError or a ValueError or is not finite there is no solution, and the
    continuation takes a shorter step; other errors, ModelError too, are passed on.  Raises ModelError for a scale
    that is not positive and for a shape that does not fit.

    >>> circle = Equations(lambda x, p: x**2 + p**2 - 1.0, scale=[1.0, 1.0])
    >>> circle.correct(np.array([0.9, 0.6]), np.array([0.0, 1.0])).z.round(12)
    array([0.8, 0.6])
    """

    def __init__(
        self,
        residual: Callable[[Array, float], ArrayLike],
        jacobian: Callable[[Array, float], ArrayLike] | None = None,
        *,
        scale: ArrayLike,
        tests: Mapping[str, Callable[[Array, float], float]] | None = None,
        branch_points: bool = False,
        tolerance: float = 1e-12,
        most_iterations: int = 12,
    ) -> None:
        self.scale: Array = np.array(scale, dtype=float)
        if self.scale.ndim != 1 or not self.scale.size or not np.all(np.isfinite(self.scale) & (self.scale > 0.0)):
            raise ModelError(
                "must be one positive number for each unknown and the parameter", where="scale", found=repr(scale)
            )
        self._residual, self._jacobian = residual, jacobian
        self._functions = dict(tests or {})
        self._branch_points, self._tolerance, self._most_iterations = branch_points, tolerance, most_iterations
        self.tests: tuple[str, ...] = (*self._functions, *([BRANCH_POINT] if branch_points else []))
        if FOLD in self._functions or len(set(self.tests)) < len(self.tests):
            raise ModelError("is taken", where="tests", found=", ".join(self.tests), remedy="give another name")

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method on F(z) = 0 in the plane normal · (z − guess) = 0, all in scaled variables."""
        with np.errstate(all="ignore"):
            try:
                return self._newton(np.array(guess, dtype=float), np.asarray(normal, dtype=float))
            except ModelError:
                raise
            except (ArithmeticError, ValueError):  # LinAlgError is a ValueError
                return self._failed(guess, self._most_iterations)

    def _failed(self, z: Array, iterations: int) -> Corrected:
        return Corrected(z, np.full(z.shape, np.nan), iterations, np.inf, False, np.full(len(self.tests), np.nan))

    def _newton(self, z: Array, normal: Array) -> Corrected:
        before = np.inf
        bordered = np.empty((z.size, z.size))
        bordered[-1] = normal
        right = np.zeros(z.size)  # its last entry stays: the first guess is in the plane, and so is every step
        for iteration in range(self._most_iterations + 1):
            right[:-1] = F = self._F(z)
            bordered[:-1] = self._F_z(z)
            step = np.linalg.solve(bordered, right)
            size = float(np.sqrt(step.dot(step)))
            if not np.isfinite(size):
                break
            # The error left after this step, from the rate at which the steps shrink (Deuflhard, Newton Methods, 2.1).
            left = size * min(1.0, size / before) if iteration else size
            if size <= self._tolerance * max(1.0, float(np.sqrt(z.dot(z)))):
                return self._presented(z, F, bordered, iteration)
            z = z - step
            if left <= self._tolerance * max(1.0, float(np.sqrt(z.dot(z)))):
                bordered[:-1] = self._F_z(z)
                return self._presented(z, self._F(z), bordered, iteration + 1)
            before = size
        return self._failed(z, self._most_iterations)

    def _presented(self, z: Array, F: Array, bordered: Array, iterations: int) -> Corrected:
        tangent = _tangent(bordered)
        x, p = self._split(z)
        values = [float(function(x, p)) for function in self._functions.values()]
        if self._branch_points:
            values.append(branch_test(bordered[:-1], tangent))
        residual = float(np.max(np.abs(F), initial=0.0))
        converged = bool(np.isfinite(residual) and np.all(np.isfinite(tangent)))
        return Corrected(z, tangent, iterations, residual, converged, np.array(values))

    def _split(self, z: Array) -> tuple[Array, float]:
        physical = z * self.scale
        return physical[:-1], float(physical[-1])

    def _F(self, z: Array) -> Array:
        F = np.asarray(self._residual(*self._split(z)), dtype=float)
        if F.shape != (z.size - 1,):
            raise ModelError("has a wrong shape", where="residual", found=str(F.shape), allowed=str((z.size - 1,)))
        return F

    def _F_z(self, z: Array) -> Array:
        if self._jacobian is None:
            return self._differences(z)
        found = np.asarray(self._jacobian(*self._split(z)), dtype=float)
        if found.shape != (z.size - 1, z.size):
            allowed = f"{(z.size - 1, z.size)}, derivatives by x and, last, by p"
            raise ModelError("has a wrong shape", where="jacobian", found=str(found.shape), allowed=allowed)
        return found * self.scale

    def _differences(self, z: Array) -> Array:
        found = np.empty((z.size - 1, z.size))
        for column in range(z.size):
            above, below = z.copy(), z.copy()
            above[column] += DIFFERENCE_STEP * max(1.0, abs(z[column]))
            below[column] -= DIFFERENCE_STEP * max(1.0, abs(z[column]))
            found[:, column] = (self._F(above) - self._F(below)) / (above[column] - below[column])
        return found


def _tangent(bordered: Array) -> Array:
    """The null vector of all rows but the last, of length one, along the last row.

    Exact also where the last row nearly lies among the others: the large error is along the null vector.
    """
    last = np.zeros(len(bordered))
    last[-1] = 1.0
    found = np.linalg.solve(bordered, last)
    return np.asarray(found / np.sqrt(found.dot(found)), dtype=float)
