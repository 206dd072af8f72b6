r"""Natural units: the same problem in numbers near one.

Absolute tolerances of solvers mean nothing for a body of 0.1 kg that moves by 1e-6 m. With

.. math:: \delta q = \rho\,S\,x,\qquad \text{lengths in units of } \rho\,\ell

Eqs. :eq:`eq-13` and :eq:`eq-4` keep their form: S is diagonal, one unit per coordinate, such that
the diagonal of H becomes about one; ell is one length, such that the rows become about one; and
rho is the size of the step. The matrices do not depend on rho, because the problem is positively
homogeneous in (g, phi). With x dimensionless, rho S is in m or rad, rho ell in m and rho / ell in
N s; rho itself is in the unit of ||v||_H, (N m s)^0.5. All units are powers of two, so the
conversion loses nothing, unless a number leaves the range of float64.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.standard_form import Units
from quasistatic_ref.tolerances import UNMOVED

SMALLEST = 2.0**-960
"""Least size of a step, over the largest of 1 and of the units of its coordinates: what is divided
by the size, times such a unit, is a float64."""


def squared_lengths(A: Array, unit: Array) -> Array:
    """Squared lengths of the rows of A S, shape (m,) [m^2/(N m s)], of any columns of A.

    Parameters
    ----------
    A : ndarray, shape (m, w)
        [m] per unit of delta_q.
    unit : ndarray, shape (w,) or (m, w)
        Of these columns, the diagonal of S [m or rad, per (N m s)^0.5].
    """
    if not A.shape[1]:
        return np.zeros(len(A))
    # Added in one order, so that columns of zeros change nothing.
    return np.asarray(np.add.accumulate(np.square(A * unit), axis=1)[:, -1])


class Sizes(NamedTuple):
    """How large a step is, by its rows and its load.

    Parameters
    ----------
    median : float
        Length of the rows of A S that are not zero; 1 if there are none [m per (N m s)^0.5].
    most : float
        Largest square of these lengths [m^2/(N m s)].
    push_out : float
        Largest entry of b, at least 0: of penetration [m].
    free_length : float
        ||H^-1 g||_H [(N m s)^0.5].
    """

    median: float
    most: float
    push_out: float
    free_length: float


def sizes_of(squares: Array, b: Array, free_length: float) -> Sizes:
    """The sizes from which natural units follow.

    Parameters
    ----------
    squares, b : ndarray, shapes (m,) and (m,)
        Squared lengths of the rows of A S [m^2/(N m s)]; ends of the rows [m].
    free_length : float
        As of :class:`Sizes` [(N m s)^0.5].
    """
    median = _median_length(squares[squares != 0])
    return Sizes(median, float(squares.max(initial=0.0)), float(b.max(initial=0.0)), free_length)


def natural_units(coordinate: Array, sizes: Sizes) -> Units:
    """Natural units of a step; not finite where its numbers are not.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    sizes : Sizes
    """
    length = _power_of_two(sizes.median)
    push_out = sizes.push_out / length
    if not math.isfinite(sizes.most):
        push_out = math.nan
    return Units(coordinate, length, natural_size(coordinate, sizes.free_length, push_out))


def natural_size(coordinate: Array, free_length: float, push_out: float) -> float:
    """The natural size rho of a step [(N m s)^0.5], NaN where its numbers are not finite.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    free_length, push_out : float
        ||H^-1 g||_H, and the longest way out of a penetration [(N m s)^0.5].
    """
    size = max(free_length, push_out)
    softest = float(coordinate.max(initial=0.0))
    if size == 0:  # no load, no penetration: the optimum is zero
        size = UNMOVED / softest if coordinate.size else UNMOVED
    if not math.isfinite(free_length + push_out):
        return math.nan
    return _power_of_two(max(size, SMALLEST * max(1.0, softest)))


def in_si(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) [m, rad] and lam (m,) [N s] in SI units from their values in natural units."""
    return delta_q * (units.size * units.coordinate), lam * (units.size / units.length)


def in_natural(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) and lam (m,) in natural units [-] from their values in SI units."""
    return delta_q / (units.size * units.coordinate), lam / (units.size / units.length)


def _median_length(squares: Array) -> float:
    """The median of lengths, from their squares; 1 if there are none."""
    n = len(squares)
    if not n:
        return 1.0
    middle = [(n - 1) // 2, n // 2]
    low, high = np.partition(squares, middle)[middle].tolist()
    return (math.sqrt(low) + math.sqrt(high)) / 2


def _power_of_two(x: float) -> float:
    if not 0 < x < math.inf:
        return math.nan
    exponent = round(math.log2(x))
    return 2.0**exponent if exponent < 1024 else math.inf


def out_of_range() -> StepDataError:
    """The error for a step whose numbers are finite but whose natural units are not."""
    return StepDataError(
        "its numbers are too large, too small or too different: products of them exceed the "
        "range of float64; look for a wrong unit"
    )
