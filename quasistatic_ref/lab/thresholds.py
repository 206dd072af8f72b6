"""Exact steps over a grid of parameters: thresholds by bisection, and exponents, for claims.

Whole scenarios are swept by ``sweep.py``.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution

PRECISION = 1e-13
"""Where the bisection of a threshold ends, relative; below CLOSED_FORM."""


def grid(*axes: Sequence[float] | Array) -> Array:
    """All combinations of some axes' values [any unit], shape (N, number of axes)."""
    return np.array(np.meshgrid(*axes, indexing="ij"), dtype=np.float64).reshape(len(axes), -1).T


def slope(x: ArrayLike, y: ArrayLike) -> float:
    """Exponent p of y = c x^p, fitted by least squares to the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def exact(step: StepData) -> StepSolution:
    """The step's optimum, exact and without any solver."""
    return solve_step(step, NONE)


def threshold(
    moves: Callable[[float], bool], low: float, high: float, precision: float = PRECISION
) -> float:
    """Where a load begins to move something, by bisection.

    Parameters
    ----------
    moves : callable
        Whether a share of the load moves the body.
    low, high : float
        Shares [-]; where `low` moves already, or `high` does not yet, NaN is returned.
    precision : float
        Of the result, relative to `high` [-].

    Returns
    -------
    float
        A share [-].
    """
    if moves(low) or not moves(high):
        return float("nan")
    while high - low > precision * high:
        middle = (low + high) / 2
        low, high = (low, middle) if moves(middle) else (middle, high)
    return high


def threshold_near(
    moves: Callable[[float], bool],
    expected: float,
    within: tuple[float, float] = (0.5, 2.0),
    precision: float = PRECISION,
) -> float:
    """A threshold by bisection of the narrowest interval about the expected load that holds it.

    Parameters
    ----------
    moves : callable
        Whether a load moves the body.
    expected : float
        About where the threshold is [unit of the load].
    within : (float, float)
        Between which multiples of that it is looked for [-].
    precision : float
        Of the result, relative [-].

    Returns
    -------
    float
        A load [its unit]; NaN where none of the intervals has the threshold in it.
    """
    widths = 10.0 ** np.arange(np.log10(precision) + 1, 0)
    for low, high in [*((1 - width, 1 + width) for width in widths), within]:
        load = threshold(moves, low * expected, high * expected, precision)
        if not np.isnan(load):
            break
    return load


def thresholds(
    step: Callable[..., StepData],
    sweep: Array,
    limits: Array,
    within: tuple[float, float] = (0.5, 2.0),
    part: slice | list[int] = slice(None),
) -> Array:
    """Where steps begin to move something, by bisection on exact answers, shape (N,).

    Parameters
    ----------
    step : callable
        From what is bisected, and a row of the sweep.
    sweep : ndarray, shape (N, k)
        What varies, a row for each threshold [SI].
    limits : ndarray, shape (N,)
        About where each threshold is [unit of what is bisected].
    within : (float, float)
        Between which multiples of that it is looked for [-].
    part : slice or list of int
        Of delta_q: what has to move.
    """

    def moves(x: float, of: Array) -> bool:
        return bool(np.any(exact(step(x, *of)).delta_q[part]))

    return np.array(
        [
            threshold_near(partial(moves, of=of), limit, within)
            for of, limit in zip(sweep, limits, strict=True)
        ]
    )
