r"""A rigorous bound of the error of an answer, in float64: for steps where balls take too long.

The theorem of :mod:`~quasistatic_ref.optional.large.bound` for a point x' = x + t v that is never
formed: with r = H x - g - A'y, s = A x - b and y >= 0, if s + t A v >= 0, then

.. math:: \|x - x^*\|_H \le t \|v\|_H
          + \sqrt{(\|r\|_{H^{-1}} + t \|v\|_H)^2 + 2 y^T s + 2 t\, y^T A v}.

Proof: x' is feasible, so that ||x' - x*||_H^2 / 2 + f(x*) - d(y) <= f(x') - d(y), which is
||r + t H v||_{H^-1}^2 / 2 + y'(s + t A v); and ||x - x'||_H = t ||v||_H. The right side thus bounds
(||x - x*||_H^2 + 2 (f(x*) - d(y)))^(1/2), too.

H, g, A and b are those of the exact step. How far float64 may be from them, and from their products
with x, v and y, is what :mod:`~quasistatic_ref.optional.large.sizes` bounds. Every operation
below is rounded outwards.
"""

import math
from collections.abc import Iterator
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from quasistatic_ref.optional.large.least_eigenvalues import least_eigenvalues
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.optional.large.outward import above, below, down, total, total_of_products, up
from quasistatic_ref.optional.large.sizes import (
    Matrix,
    TermSizes,
    in_range,
    rounding,
    row_sizes,
    step_sizes,
)
from quasistatic_ref.solve.units import StepInBothUnits, in_natural
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

ENOUGH = 1 + 2.0**-40
"""How much farther than needed x is moved, so that rounding does not undo it."""

OPENED = 0.1
"""By how much a kept direction must open the rows that x may violate [-]. A new one opens them by
half of their lengths, which are about one."""


class FloatBound:
    """Bounds for steps of one H in the same units of coordinates, in natural units.

    Parameters
    ----------
    H : ndarray or scipy.sparse.csc_matrix, shape (n_v, n_v)
        Symmetric, each entry rounded once [-].

    Attributes
    ----------
    direction : ndarray, shape (n_v,), or None
        The v of the last bound that needed one.
    """

    def __init__(self, H: Matrix) -> None:
        self.H = H
        self.direction: Array | None = None

    @cached_property
    def least(self) -> Array:
        """A lower bound of the eigenvalues of each coordinate's block, shape (n_v,)."""
        return least_eigenvalues(csc_matrix(self.H))

    @cached_property
    def sizes(self) -> Matrix:
        """The absolute values of H."""
        return abs(self.H)

    @cached_property
    def most(self) -> Array:
        """Row sums of |H|, rounded up, shape (n_v,): v'Hv is at most their product with v^2."""
        total = np.asarray(self.sizes.sum(axis=0)).ravel()
        return above(total + rounding(self.entries, total))

    @cached_property
    def entries(self) -> int:
        """Most entries of a row."""
        return int(np.diff(csc_matrix(self.H).indptr).max(initial=0))

    @cached_property
    def factor(self) -> SuperLU:
        """The factors L and U of H, in float64."""
        return splu(csc_matrix(self.H))

    def step_error(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """The bound [-] of a step in dense matrices, from an answer in SI units.

        It is infinite where a user's cost is in H: terms of H may cancel, so that its entries do
        not bound their rounding.

        Parameters
        ----------
        both : StepInBothUnits
            In a polyhedral cone.
        delta_q : ndarray, shape (n_v,)
            [m, rad].
        lam : ndarray, shape (m,)
            [N s]
        """
        step = both.si_step
        if step.extra.cost is not None:
            return math.inf
        A = row_sizes(step, step.contacts.J)
        if step.extra.names:
            A = np.concatenate([A, np.abs(step.extra.A)])
        A *= both.units.coordinate / both.units.length
        sizes = step_sizes(step, A, both.units)
        return self.error(both.natural_form, sizes, *in_natural(delta_q, lam, both.units))

    def error(self, form: StandardForm, sizes: TermSizes, x: Array, lam: Array) -> float:
        """A bound of ||x - x*||_H / ||H^-1 g||_H [-], infinite where none is known.

        Its square bounds ||x - x*||_H^2 + 2 (f(x*) - d(lam)) over ||H^-1 g||_H^2, too.

        Parameters
        ----------
        form : StandardForm
            In natural units.
        sizes : TermSizes
            Of that form.
        x : ndarray, shape (n_v,)
            The answer [-].
        lam : ndarray, shape (m,)
            Its multipliers [-]; negative ones are taken as zero.
        """
        y = np.maximum(lam, 0.0)
        if not (in_range(x, y, form.b) and sizes.usable and (self.least > 0).all()):
            return math.inf
        free = self.free_length(form.g, sizes)
        if not free > 0:
            return math.inf
        s = form.A @ x - form.b
        e = rounding(sizes.row_terms, sizes.rows(x) + np.abs(form.b))
        way = 0.0
        work = total_of_products(y, above(s + e))
        low = below(s - e)
        if low.min(initial=0.0) < 0:
            way, pressed = self.moved(form.A, sizes, s, low, y)
            if not way < math.inf:
                return math.inf
            work = up(work + pressed)
        r = self.H @ x - form.g - form.A.T @ y
        e = self.sizes @ np.abs(x) + sizes.load + sizes.columns(y)
        r = above(np.abs(r) + rounding(max(sizes.column_terms, self.entries), e))
        unbalanced = up(math.sqrt(total(above(above(r * r) / self.least))))
        moved = up(unbalanced + way)
        length = up(way + up(math.sqrt(up(up(moved * moved) + 2 * max(work, 0.0)))))
        return up(length / free)

    def moved(
        self, A: Matrix, sizes: TermSizes, s: Array, low: Array, y: Array
    ) -> tuple[float, float]:
        """Bounds of t ||v||_H and t y'A v [-] for some v; infinite if none is found.

        Parameters
        ----------
        A : ndarray or scipy.sparse.csc_matrix, shape (m, n_v)
        sizes : TermSizes
        s, low, y : ndarray, shape (m,)
            A x - b and a lower bound of it, some of which is negative; and multipliers >= 0 [-].
        """
        for v, least in self.directions(A, s):
            opens = A @ v
            e = rounding(sizes.row_terms, sizes.rows(v))
            surely = below(opens - e)
            t = least_way(low, surely, least)
            if t < math.inf:
                self.direction = v
                way = up(t * up(math.sqrt(total_of_products(above(v * v), self.most))))
                return way, up(t * max(total_of_products(y, above(opens + e)), 0.0))
        return math.inf, math.inf

    def directions(self, A: Matrix, s: Array) -> Iterator[tuple[Array, float]]:
        """The v that is kept, then a new one, shape (n_v,); and by how much they have to open rows.

        Parameters
        ----------
        A : ndarray or scipy.sparse.csc_matrix, shape (m, n_v)
        s : ndarray, shape (m,)
            A x - b [-].
        """
        if self.direction is not None:
            yield self.direction, OPENED
        v = opening(csc_matrix(A), s)
        if v is not None and in_range(v):
            yield v, 0.0

    def free_length(self, g: Array, sizes: TermSizes) -> float:
        """A lower bound of ||H^-1 g||_H [-], g (n_v,): the largest g'z / ||z||_H of any z."""
        z = np.asarray(self.factor.solve(g))
        if not in_range(z):
            return 0.0
        e_g = rounding(sizes.column_terms, sizes.load)
        e_H = rounding(self.entries, self.sizes @ np.abs(z))
        along = -up(total_of_products(-g, z) + total_of_products(e_g, np.abs(z)))
        square = up(total_of_products(self.H @ z, z) + total_of_products(e_H, np.abs(z)))
        return down(along / up(math.sqrt(square))) if along > 0 else 0.0


def least_way(low: Array, opens: Array, least: float = 0.0) -> float:
    """A t >= 0 [-] with low + t opens >= 0 for all rows, each (m,) [-]; infinite if unknown.

    It is unknown, too, if a row whose low is negative opens by less than `least` [-].
    """
    (short,) = (low < 0).nonzero()
    opened = opens.take(short)
    slowest = float(opened.min(initial=math.inf))
    if not (slowest > 0 and slowest >= least):
        return math.inf
    t = float((-low.take(short) / opened).max(initial=0.0)) * ENOUGH
    return t if bool((below(low + below(t * opens)) >= 0).all()) else math.inf
