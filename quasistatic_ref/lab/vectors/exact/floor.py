r"""The least error that an answer to a quadratic program is allowed, whatever its condition.

Where contacts hold a body fast, delta_q is a small number or 0, and its componentwise bound is next
to nothing: yet it is what is left of the unconstrained step H^-1 g when the contacts have taken
theirs, and a solver that does not know that beforehand rounds both. A few roundings of it, in the
norm in which the package measures every error,

.. math:: \|x - x^*\|_H \le 8 \cdot 2^{-53}\,\|H^{-1} g\|_H,

move an entry of x by as many sqrt((H^-1)_vv) at most, one of A'lam = H x - g by sqrt(H_vv), and a
slack by sqrt((A H^-1 A')_ii).
"""

from fractions import Fraction
from math import isqrt
from typing import Final

import numpy as np

from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.lab.vectors.exact.rational import UNIT, inverse, largest, rationals

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
    H, A, g = (rationals(M) for M in (form.H, form.A, form.g.entries()))
    H_inverse = inverse(H)
    energy = ROUNDINGS**2 * (g @ H_inverse @ g)
    slacks = np.sum((A @ H_inverse) * A, axis=1)
    squares = (
        (np.diag(H_inverse), form.x_unit),
        (np.diag(H), form.net_unit),
        (slacks, form.slack_unit),
    )
    x, net, slack = (UNIT * _root(largest(v * energy, unit * unit)) for v, unit in squares)
    return x, net, slack


def _root(value: Fraction) -> Fraction:
    """A square root, rounded up; 0 of 0."""
    p = value.numerator
    q = value.denominator
    return Fraction(isqrt((p * q << 2 * BITS) - 1) + 1, q << BITS) if p else Fraction(0)
