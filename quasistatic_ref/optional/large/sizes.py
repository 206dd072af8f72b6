r"""How far H, g, A, b and their products in float64 may be from those of the exact step.

A sum of products, in any order, with at most D roundings from each of its numbers to the result,
is off by at most :math:`\gamma_D = D u / (1 - D u)` times the sum of the sizes of its terms
(u = 2^-53). That sum is formed in float64 too, in at most D roundings, so that it is too small by
a factor of :math:`1 - \gamma_D` at most. What underflows is off by TINY at most.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_matrix

from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.cones import cone_matrix
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.friction import scaled_by

Matrix: TypeAlias = "Array | csc_matrix"

UNIT = 2.0**-53
"""Largest relative error of one operation."""

ROUNDINGS = 10
"""Roundings from a number of the step to a result, beyond one for each term of the longest sum.

The sizes of H x - g - A'lam have most: those of an entry of A (8: axes 3, mu 1, cone 4), the
product with lam (1), the sum over c rows (c - 1), and two sums with H x and g (2)."""

MORE = 1 + 2.0**-50
"""Covers the five roundings of a bound of roundings itself."""

LARGEST = 2.0**100
"""Numbers in natural units beyond it are given no bound."""

TINY = 2.0**-604
"""2^70 underflows of 2^-1074 each, times four numbers of LARGEST."""


def rounding(terms: int, sizes: Array) -> Array:
    """What sums of so many terms may be off by, shape (k,), from their `sizes` (k,) [-]."""
    D = terms + ROUNDINGS
    part = D * UNIT / (1 - 2 * D * UNIT)  # gamma_D / (1 - gamma_D)
    return MORE * part * sizes + TINY


def in_range(*numbers: ArrayLike) -> bool:
    """Whether no number of some arrays, of any shapes and units, is beyond LARGEST, nor NaN."""
    flat = np.concatenate(numbers, axis=None)
    return float(np.abs(flat).max(initial=0.0)) <= LARGEST


@dataclass(frozen=True, eq=False)
class TermSizes:
    """Sums of the sizes of all terms of A x, A'lam and g, in natural units.

    Parameters
    ----------
    A : ndarray or scipy.sparse.csc_matrix, shape (m, n_v)
        Of each entry of A [-].
    load : ndarray, shape (n_v,)
        Of g [-].
    row_terms, column_terms : int
        Most terms of a row of A, and of a column of A or a sum in g.
    usable : bool
        Whether no number is beyond LARGEST.
    """

    A: Matrix
    load: Array
    row_terms: int
    column_terms: int
    usable: bool

    def rows(self, x: Array) -> Array:
        """Of A x, shape (m,), from x (n_v,)."""
        return np.asarray(self.A @ np.abs(x))

    def columns(self, lam: Array) -> Array:
        """Of A'lam, shape (n_v,), from lam >= 0 (m,)."""
        return np.asarray(self.A.T @ lam)


def term_sizes(
    A: Matrix, load: Array, load_terms: int = 0, numbers: Iterable[ArrayLike] = ()
) -> TermSizes:
    """The sizes of a program.

    Parameters
    ----------
    A : ndarray or scipy.sparse.csc_matrix, shape (m, n_v)
    load : ndarray, shape (n_v,)
        As of :class:`TermSizes` [-].
    load_terms : int
        Most terms of a sum in g.
    numbers : iterable of ndarray or float, each of any shape
        Further factors of the terms [their units], none of which may be beyond LARGEST.
    """
    if isinstance(A, np.ndarray):
        column_terms, row_terms = A.shape
        entries = A
    else:
        column_terms = int(np.diff(A.indptr).max(initial=0))
        row_terms = int(np.bincount(A.indices).max(initial=0))
        entries = A.data
    usable = in_range(entries, load, *numbers)
    return TermSizes(A, load, row_terms, max(column_terms, load_terms), usable)


def row_sizes(step: StepData, J: Array) -> Array:
    """The sizes of Eq. :eq:`eq-4`'s terms [m] per unit of delta_q, shape (rows of contacts, w).

    Parameters
    ----------
    step : StepData
        In a cone that has rows.
    J : ndarray, shape (n_c, 4, w)
        Any columns of J.
    """
    contacts = step.contacts
    axes = np.abs([contacts.n, contacts.d1, contacts.d2]).swapaxes(0, 1)
    J = np.abs(J)
    motion = np.concatenate([axes @ J[:, :3], J[:, 3:]], axis=1)
    rows = np.abs(cone_matrix(step.cone)) @ (scaled_by(contacts)[:, :, None] * motion)
    return np.asarray(rows[step.mask])


def step_sizes(step: StepData, A: Matrix, units: Units) -> TermSizes:
    """The sizes of a step whose cone has rows.

    Parameters
    ----------
    step : StepData
        SI units.
    A : ndarray or scipy.sparse.csc_matrix, shape (m, n_v)
        Its :func:`row_sizes` in natural units [-].
    units : Units
    """
    S = units.coordinate
    of_load = S / units.size
    spring = np.abs(step.K_q) @ np.abs(step.delta_q_bar_a)  # Eq. (1)
    load = np.concatenate([spring + np.abs(step.tau_a), np.abs(step.tau_u)]) * step.h * of_load
    scales = [step.h, 1 / units.length, 1 / units.size]
    numbers: list[ArrayLike] = [step.contacts.mu, S, S / units.length, of_load, scales]
    return term_sizes(A, load, step.n_a, numbers)
