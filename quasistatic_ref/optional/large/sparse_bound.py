r"""A rigorous bound of the error of an answer to a large step, in float64.

The theorem of :mod:`~quasistatic_ref.optional.large.bound` for a point x' = x + t v that is never
formed: with r = H x - g - A'y, s = A x - b and y >= 0, if s + t A v >= 0, then

.. math:: \|x - x^*\|_H \le t \|v\|_H
          + \sqrt{(\|r\|_{H^{-1}} + t \|v\|_H)^2 + 2 y^T s + 2 t\, y^T A v}.

H, g, A and b are those of the exact step. How far float64 may be from them, and from their products
with x, v and y, is what :mod:`~quasistatic_ref.optional.large.sizes` bounds. Every operation
below is rounded outwards.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from quasistatic_ref.optional.large.least_eigenvalues import least_eigenvalues
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.optional.large.outward import above, below, down, total, total_of_products, up
from quasistatic_ref.optional.large.sizes import LARGEST, TermSizes, rounding
from quasistatic_ref.step.data import Array

ENOUGH = 1 + 2.0**-40
"""How much farther than needed x is moved, so that rounding does not undo it."""


@dataclass(frozen=True, eq=False)
class SparseHessian:
    """What the bound takes from H alone.

    Parameters
    ----------
    H : scipy.sparse.csc_matrix, shape (n_v, n_v)
        Symmetric, each entry rounded once.
    """

    H: csc_matrix

    @cached_property
    def least(self) -> Array:
        """A lower bound of the eigenvalues of each coordinate's block, shape (n_v,)."""
        return least_eigenvalues(self.H)

    @cached_property
    def most(self) -> Array:
        """Row sums of |H|, rounded up, shape (n_v,): v'Hv is at most their product with v^2."""
        total = np.asarray(abs(self.H).sum(axis=0)).ravel()
        return above(total + rounding(self.entries, total))

    @cached_property
    def entries(self) -> int:
        """Most entries of a row."""
        return int(np.diff(self.H.indptr).max(initial=0))

    @cached_property
    def factor(self) -> SuperLU:
        """The factors L and U of H, in float64."""
        return splu(self.H)

    def sizes(self, x: Array) -> Array:
        """Sums of the absolute values of all terms of H x, shape (n_v,), from x (n_v,)."""
        return np.asarray(abs(self.H) @ np.abs(x))


@dataclass(frozen=True, eq=False)
class LargeForm:
    """The quadratic program of a large step in float64, and the magnitudes of its terms.

    Parameters
    ----------
    metric : SparseHessian
        Of H.
    g : ndarray, shape (n_v,)
    A : scipy.sparse.csc_matrix, shape (m, n_v)
    b : ndarray, shape (m,)
    sizes : TermSizes
        Sums of the absolute values of all terms of A x, A'y and g, for bounds of their rounding.
    """

    metric: SparseHessian
    g: Array
    A: csc_matrix
    b: Array
    sizes: TermSizes


def sparse_error_bound(form: LargeForm, x: Array, lam: Array) -> float:
    """A bound of ||x - x*||_H / ||H^-1 g||_H [-], infinite where none is known.

    Its square bounds ||x - x*||_H^2 + 2 (f(x*) - d(lam)) over ||H^-1 g||_H^2, too.

    Parameters
    ----------
    form : LargeForm
        In natural units.
    x : ndarray, shape (n_v,)
        The answer [-].
    lam : ndarray, shape (m,)
        Its multipliers [-]; negative ones are taken as zero.
    """
    y = np.maximum(lam, 0.0)
    sizes = form.sizes
    metric = form.metric
    free = free_length(form)
    small = all(float(np.abs(v).max(initial=0.0)) <= LARGEST for v in (x, y, form.b))
    if not (small and sizes.usable and free > 0 and (metric.least > 0).all()):  # NaN is not small
        return math.inf
    s = form.A @ x - form.b
    e = rounding(sizes.row_terms, sizes.rows(x) + np.abs(form.b))
    low = below(s - e)
    work = total_of_products(y, above(s + e))
    way = 0.0
    if low.min(initial=0.0) < 0:
        d = opening(form.A, s)  # v above
        if d is None or not float(np.abs(d).max()) <= LARGEST:
            return math.inf
        opens = form.A @ d
        e = rounding(sizes.row_terms, sizes.rows(d))
        t = least_way(low, below(opens - e))
        if not t < math.inf:
            return math.inf
        way = up(t * up(math.sqrt(total_of_products(above(d * d), metric.most))))
        work = up(work + up(t * max(total_of_products(y, above(opens + e)), 0.0)))
    r = metric.H @ x - form.g - form.A.T @ y
    e = metric.sizes(x) + sizes.load + sizes.columns(y)
    r = above(np.abs(r) + rounding(max(sizes.column_terms, metric.entries), e))
    unbalanced = up(math.sqrt(total(above(above(r * r) / metric.least))))
    moved = up(unbalanced + way)
    length = up(way + up(math.sqrt(up(up(moved * moved) + 2 * max(work, 0.0)))))
    return up(length / free)


def free_length(form: LargeForm) -> float:
    """A lower bound of ||H^-1 g||_H [-], which is the largest g'z / ||z||_H of any z."""
    metric = form.metric
    sizes = form.sizes
    z = np.asarray(metric.factor.solve(form.g))
    if not float(np.abs(z).max(initial=0.0)) <= LARGEST:
        return 0.0
    e_g = rounding(sizes.column_terms, sizes.load)
    e_H = rounding(metric.entries, metric.sizes(z))
    along = -up(total_of_products(-form.g, z) + total_of_products(e_g, np.abs(z)))
    square = up(total_of_products(metric.H @ z, z) + total_of_products(e_H, np.abs(z)))
    return down(along / up(math.sqrt(square))) if along > 0 else 0.0


def least_way(low: Array, opens: Array) -> float:
    """A t >= 0 [-] with low + t opens >= 0 for all rows, each (m,) [-]; infinite if unknown."""
    short = low < 0
    if not (opens[short] > 0).all():
        return math.inf
    t = float((-low[short] / opens[short]).max(initial=0.0)) * ENOUGH
    return t if bool((below(low + below(t * opens)) >= 0).all()) else math.inf
