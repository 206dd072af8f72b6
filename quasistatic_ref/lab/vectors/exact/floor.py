r"""The least error that an answer to a quadratic program is allowed, whatever its condition.

Where contacts hold a body fast, delta_q is a small number or 0, and its componentwise bound is next
to nothing: yet it is what is left of the unconstrained step H^-1 g when the contacts have taken
theirs, and a solver that does not know that beforehand rounds both. A few roundings of it, in the
norm in which the package measures every error,

.. math:: \|x - x^*\|_H \le 8 \cdot 2^{-53}\,\|H^{-1} g\|_H,

move an entry of x by as many sqrt((H^-1)_vv) at most, one of A'lam = H x - g by sqrt(H_vv), and a
slack by sqrt((A H^-1 A')_ii).
"""

from collections.abc import Iterable
from fractions import Fraction
from math import isqrt
from typing import Final

from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.lab.vectors.exact.rational import UNIT, fraction

ROUNDINGS: Final = 8
"""Of the unconstrained step: an answer of 15 digits."""
BITS: Final = 64
"""Of a square root, which is rounded up."""


def floors(form: ExactForm) -> tuple[Fraction, Fraction, Fraction]:
    """Errors of the largest entry of x [m, rad], of A'lam [N s, N m s] and of the slacks [m].

    Parameters
    ----------
    form : ExactForm
    """
    H, A, g = fmpq_mat(form.H), fmpq_mat(form.A), fmpq_mat(form.g)
    inverse = H.inv()
    energy = (g.transpose() * inverse * g)[0, 0] * fmpq(ROUNDINGS**2)
    image = A * inverse
    slacks = (
        sum((image[i, v] * A[i, v] for v in range(form.n)), start=fmpq(0)) for i in range(form.m)
    )
    return (
        _reach((inverse[v, v] for v in range(form.n)), energy, form.x_unit),
        _reach((H[v, v] for v in range(form.n)), energy, form.net_unit),
        _reach(slacks, energy, form.slack_unit),
    )


def _reach(squares: Iterable[fmpq], energy: fmpq, unit: fmpq) -> Fraction:
    """The largest square root of s energy, in SI units."""
    largest = max(squares, default=fmpq(0)) * energy * unit * unit
    return UNIT * _root(fraction(largest))


def _root(value: Fraction) -> Fraction:
    """A square root, rounded up; 0 of 0."""
    p, q = value.numerator, value.denominator
    return Fraction(isqrt((p * q << 2 * BITS) - 1) + 1, q << BITS) if p else Fraction(0)
