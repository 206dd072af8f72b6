"""H of Eq. :eq:`eq-13`, kept by what it is made of: K_q, and M_u or its blocks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array, Indices, all_finite, read_only
from quasistatic_ref.numbers.blocks import entries_of, nonzeros, whole
from quasistatic_ref.numbers.pivots import positive_definite
from quasistatic_ref.text.plain import Plain

Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Hessian(Plain):
    """H of steps, without a user's cost: h K_q of the springs, M_u / h of what moves freely.

    Steps of one run share it as long as their M_u is the same, and what was formed of it once.

    Parameters
    ----------
    h : float
        [s]
    K_q : ndarray, shape (n_a, n_a)
        [N/m, N m/rad]
    masses : ndarray, shape (n_u, n_u), or (k, n_u / k, n_u / k)
        M_u, or its diagonal blocks [kg, kg m, kg m^2].
    """

    h: float
    K_q: Array
    masses: Array

    @property
    def n_a(self) -> int:
        """Number of actuated coordinates."""
        return len(self.K_q)

    @cached_property
    def M_u(self) -> Array:
        """The un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        return whole(self.masses)

    @cached_property
    def matrix(self) -> Array:
        """H, shape (n_v, n_v); StepDataError if an entry leaves the range of float64."""
        return hessian(self.h, self.K_q, self.M_u)

    @cached_property
    def entries(self) -> tuple[Indices, Indices]:
        """Rows and columns, (k,) each, of the entries of H that are not zero."""
        i, j = nonzeros(self.masses)
        of_K, of_K_column = np.nonzero(self.K_q)
        n_a = self.n_a
        return np.concatenate([of_K, n_a + i]), np.concatenate([of_K_column, n_a + j])

    def part(self, coordinates: Indices) -> Hessian:
        """H of some coordinates, (k,), formed once for the same."""
        key = coordinates.tobytes()
        parts = self._parts
        if key not in parts:
            n_a = self.n_a
            a = coordinates[coordinates < n_a]
            u = coordinates[coordinates >= n_a] - n_a
            K_q = read_only(self.K_q[np.ix_(a, a)])
            parts[key] = Hessian(self.h, K_q, read_only(entries_of(self.masses, u)))
        return parts[key]

    def changed(self, masses: Array) -> Hessian:
        """H with other `masses`, of the same shape [kg, kg m, kg m^2].

        A part whose numbers stay is the same object.
        """
        other = Hessian(self.h, self.K_q, masses)
        for key, part in [*self._parts.items()]:  # another thread may add one
            coordinates = np.frombuffer(key, np.int64)
            u = coordinates[coordinates >= self.n_a] - self.n_a
            if np.array_equal(entries_of(masses, u), part.masses):
                other._parts[key] = part
        return other

    def once(self, form: Callable[[Hessian], Result]) -> Result:
        """The result of a function of this H, computed at the first call and kept with H."""
        formed = self._formed
        if form not in formed:
            formed[form] = form(self)
        result: Result = formed[form]
        return result

    @cached_property
    def _parts(self) -> dict[bytes, Hessian]:
        return {}

    @cached_property
    def _formed(self) -> dict[Callable[[Hessian], Any], Any]:
        return {}


class Hessians:
    """H of the steps of a run: as long as M_u stays, that of the step before."""

    def __init__(self) -> None:
        self._last: Hessian | None = None

    def of(self, h: float, K_q: Array, masses: Array) -> Hessian | None:
        """H of a step; None if masses, (k, 6, 6) [kg, kg m, kg m^2], are not finite.

        Raises
        ------
        StepDataError
            If M_u is not positive definite.
        """
        last = self._last
        if last is not None and (masses is last.masses or np.array_equal(masses, last.masses)):
            return last
        if not all_finite(masses.ravel()):
            return None
        positive_definite("M_u", masses)
        new = Hessian(h, K_q, masses) if last is None else last.changed(masses)
        self._last = new
        return new


def hessian(h: float, K_q: Array, M_u: Array) -> Array:
    """H of Eq. :eq:`eq-13`, shape (n_v, n_v), from the fields of a step [s], [N/m] and [kg].

    StepDataError if an entry leaves the range of float64.
    """
    n_a = len(K_q)
    n_v = n_a + len(M_u)
    H = np.zeros((n_v, n_v))
    with np.errstate(over="ignore"):
        H[:n_a, :n_a] = h * K_q
        H[n_a:, n_a:] = M_u / h
    if not np.isfinite(H).all():
        problem = "takes h K_q or M_u / h out of the range of float64; use a usual h [s]"
        raise StepDataError(problem, field="h", value=h)
    return read_only(H)
