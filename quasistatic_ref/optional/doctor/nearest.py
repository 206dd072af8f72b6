"""The point of a polyhedron nearest to another, by DAQP, or by Clarabel if DAQP is missing."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache, partial
from importlib import import_module
from types import ModuleType

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.tolerances import ACCURACY

TOLERANCES = 1e-14, ACCURACY
"""DAQP's, over the largest motion that is asked for [-]. The first is near rounding: at the last T
what loads ask for is 1e9 times as long as what may count of a slip."""

Nearest = tuple[Array, Array]
"""The point x, shape (n,), and the multipliers of the rows, shape (m,)."""


def nearest(f: Array, A: Array, b: Array) -> Nearest | None:
    """The x nearest to f with A x >= b, and the multipliers; None without an answer.

    Parameters
    ----------
    f : ndarray, shape (n,)
        The point, in any unit [-].
    A : ndarray, shape (m, n)
        Rows of length one, or zero.
    b : ndarray, shape (m,)
        In the unit of f.

    Returns
    -------
    x : ndarray, shape (n,)
    lam : ndarray, shape (m,)
    """
    return _solver()(f, A, b)


@cache
def _solver() -> Callable[[Array, Array, Array], Nearest | None]:
    try:
        return partial(_by_daqp, import_module("daqp"))
    except ImportError:
        return _by_clarabel


@lru_cache(maxsize=16)
def _constants(n: int, m: int) -> tuple[Array, Array, Array]:
    """H, upper ends of the rows, and the kinds of the rows, as DAQP has them."""
    return np.eye(n), np.full(m, np.inf), np.zeros(m, np.int32)


def _by_daqp(daqp: ModuleType, f: Array, A: Array, b: Array) -> Nearest | None:
    H, above, kinds = _constants(len(f), len(b))
    for tolerance in TOLERANCES:
        options = {"primal_tol": tolerance, "dual_tol": tolerance}
        x, _, flag, info = daqp.solve(H, -f, A, above, b, kinds, **options)
        if flag == 1:
            return x, -info["lam"]  # those of lower bounds are negative
    return None


def _by_clarabel(f: Array, A: Array, b: Array) -> Nearest | None:
    clarabel = import_module("clarabel")
    sparse = import_module("scipy.sparse")
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    for name in ("tol_gap_abs", "tol_gap_rel", "tol_feas"):
        setattr(settings, name, ACCURACY)
    H = sparse.eye_array(len(f), format="csc")
    cones = [clarabel.NonnegativeConeT(len(b))]
    arrays = (sparse.csc_matrix(H), -f, sparse.csc_matrix(-A), -b, cones, settings)
    answer = clarabel.DefaultSolver(*arrays).solve()
    if str(answer.status) not in ("Solved", "AlmostSolved", "InsufficientProgress"):
        return None
    return np.array(answer.x), np.array(answer.z)
