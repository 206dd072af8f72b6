r"""Which stiffness and mass matrices count as positive definite.

The rule: each pivot of S, the square of an entry on the diagonal of its Cholesky factor, is above
DEFINITE times its entry of S. It is decided without rounding, because it also decides which files
are steps, and other programs have to decide alike.

Float64 suffices for nearly all matrices. Let L be the Cholesky factor of S - c D as computed, D the
diagonal of S. Whatever the order of the sums, the error is at most

.. math:: |S - c D - L L^T|_{ij} \le 2 (n + 3)\,u\,(S_{ii} S_{jj})^{1/2}, \qquad u = 2^{-53}

(Higham, Accuracy and Stability of Numerical Algorithms, theorem 10.3, with room for a division that
is a product with a reciprocal, and for the entries of S - c D). With c = 2 n (n + 3) u the matrix
S - L L' is then diagonally dominant in units in which D is one, hence not negative; so the pivots
of S are at least those of L L', which are the squares of L's diagonal.
"""

import math
from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

import numpy as np
from flint import fmpz_mat

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array

SYMMETRIC: Final = 1e-12
"""Largest |S - S'| relative to the largest entry of a stiffness or mass matrix.

Rounding in a mass matrix leaves 1e-16; anything above 1e-12 is another matrix. What is smaller
is removed: the lower triangle counts."""

DEFINITE: Final = 1e-14
"""Smallest pivot of a stiffness or mass matrix relative to its diagonal entry, which has the same
unit; decided without rounding (numbers/pivots.py).

Cholesky of a singular matrix leaves rounding of 1e-16 for a pivot; a matrix this near to one has
a condition number above 1e14, and its inverse no correct digit."""

UNIT = 2.0**-53
"""Largest relative error of one operation."""
RANGE = 2.0**-500, 2.0**500
"""Diagonal entries whose products and roots are far from the ends of float64's range."""
MANY_ROWS = 200
"""Rows of a matrix from which its blocks are looked at one by one, sooner than all of it."""


def positive_definite(key: str, S: Array) -> Array:
    """S, of shape (..., n, n) [any unit], made symmetric, if it is positive definite.

    Raises
    ------
    StepDataError
        About the field `key`, if S is not symmetric or not positive definite.
    """
    S = symmetric(key, S)
    if not _positive_pivots(S.tobytes(), S.shape):
        problem = "must be positive definite (no zero stiffness, no massless link)"
        raise StepDataError(problem, field=key, value=S.tolist())
    S.setflags(write=False)
    return S


def symmetric(key: str, S: Array) -> Array:
    """S, of shape (..., n, n) [any unit], made symmetric from its lower triangle.

    Raises
    ------
    StepDataError
        About the field `key`, if S is not symmetric.
    """
    if np.equal(S, S.mT).all():
        return np.add(S, 0.0, order="C")
    if np.abs(S - S.mT).max() > SYMMETRIC * np.abs(S).max():
        raise StepDataError("must be symmetric", field=key, value=S.tolist())
    return np.asarray(np.tril(S) + np.tril(S, -1).mT)


def positive_sum(S: Array, terms: Iterable[tuple[Fraction, Array]]) -> bool:
    """Whether the exact sum of `terms`, of which S is the rounded one, is positive definite.

    Float64 shows it where S is normal and no diagonal term is negative: each entry is then off by
    at most 8 u (S_ii S_jj)^1/2, so that the exact sum is at least S - 8 n u D, D the diagonal of S.

    Parameters
    ----------
    S : ndarray, shape (n, n)
        Symmetric [any unit]; not finite if a term's sum is not.
    terms : iterable of (Fraction, ndarray)
        A factor [-] and a matrix, shape (n, n) [any unit], that it multiplies; the factors together
        may be those of a multiple of S.
    """
    if not np.isfinite(S).all():
        return False
    if surely_positive(S * (1 - 16 * len(S) * UNIT * np.eye(len(S)))):
        return True
    exact = np.frompyfunc(Fraction, 1, 1)
    return _exactly_positive(sum(factor * exact(term) for factor, term in terms))


@lru_cache(maxsize=16)
def _positive_pivots(entries: bytes, shape: tuple[int, ...]) -> bool:
    """:func:`positive_pivots`, cached, because most steps of a run have the same matrices."""
    return positive_pivots(np.frombuffer(entries).reshape(shape))


def positive_pivots(S: Array) -> bool:
    """Whether each matrix of a stack counts as positive definite.

    Parameters
    ----------
    S : ndarray, shape (..., n, n)
        Symmetric and finite [any unit].
    """
    many = S.ndim == 2 and len(S) > MANY_ROWS
    if not many and surely_positive(S):
        return True
    if S.ndim > 2:
        return all(map(positive_pivots, S))
    blocks = _diagonal_blocks(S)
    if len(blocks) > 1:
        return all(map(positive_pivots, blocks))
    return (many and surely_positive(S)) or _exactly_positive(S)


def _exactly_positive(S: Any) -> bool:
    """Whether the pivots of a matrix (n, n), floats or fractions [any unit], obey the rule."""
    return all(exact_factor(block, DEFINITE) is not None for block in _diagonal_blocks(S))


def surely_positive(S: Array) -> bool:
    """Whether float64 shows that all matrices S, (..., n, n), are positive definite [any unit]."""
    n = S.shape[-1]
    least, most = RANGE
    try:
        L = np.linalg.cholesky(S * (1 - 2 * n * (n + 3) * UNIT * np.eye(n)))  # S - c D
    except np.linalg.LinAlgError:
        return False
    s = np.linalg.diagonal(S)
    # Twice the share, because these products are rounded.
    sure = np.square(np.linalg.diagonal(L)) > 2 * DEFINITE * s
    return bool((sure & (least < s) & (s < most)).all())


def _diagonal_blocks(S: Array) -> list[Array]:
    """The smallest blocks (k, k) on the diagonal of S, (n, n), outside of which it is zero."""
    last = [max(np.flatnonzero(row).tolist(), default=i) for i, row in enumerate(S)]
    reached = np.maximum.accumulate(last)
    ends = [i + 1 for i in range(len(S)) if reached[i] == i]
    return [S[a:b, a:b] for a, b in zip([0, *ends], ends, strict=False)]


def exact_factor(S: Array, share: float) -> Array | None:
    """The lower Cholesky factor of S, whose entries alone are rounded, by whole numbers.

    Parameters
    ----------
    S : ndarray, shape (n, n)
        Symmetric and finite, floats or fractions [any unit].
    share : float
        Above which part of its diagonal entry a pivot must be, from 0 to below 1 [-].

    Returns
    -------
    ndarray, shape (n, n), or None
        None if a pivot is not above it.
    """
    fractions = [[v.as_integer_ratio() for v in row] for row in S.tolist()]
    common = math.lcm(*(q for row in fractions for _, q in row))
    whole_numbers = [[p * (common // q) for p, q in row] for row in fractions]
    permutation, _, _, minors = fmpz_mat(whole_numbers).fflu()  # as Bareiss: all are minors of S
    if not permutation.is_one():  # a pivot is zero
        return None
    part, whole = share.as_integer_ratio()
    L = np.zeros(S.shape)
    last = 1
    for k, row in enumerate(minors.tolist()):
        above = [int(v) for v in row[k:]]
        minor = above[0]  # the pivot is minor / last
        if whole * minor <= part * whole_numbers[k][k] * last:  # so is one that is not above zero
            return None
        square = minor * last * common
        roots = [_root(v * v, square) for v in above]
        L[k:, k] = [-root if v < 0 else root for v, root in zip(above, roots, strict=True)]
        last = minor
    return L


def _root(p: int, q: int) -> float:
    """The square root of p / q [-], which itself may be out of the range of float64."""
    twos = (p.bit_length() - q.bit_length()) // 2
    near_one = (p << max(-2 * twos, 0)) / (q << max(2 * twos, 0))
    return math.ldexp(math.sqrt(near_one), twos)
