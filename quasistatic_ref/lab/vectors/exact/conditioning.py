r"""What a careful float64 solver can reach on one quadratic program: the tolerances of its answer.

On the working set W the optimum solves K z = r, with K = [[H, -A_w'], [A_w, 0]], z = [x; lam] and
r = [g; b_w]. Data and elimination that are rounded componentwise leave

.. math:: |z - z^*| \le c\,2^{-53}\,|K^{-1}|\,(|K|\,|z^*| + |r|),

the bound of Oettli and Prager (1964) with the condition of Skeel (1979): scaling rows or columns
does not change it. c counts the roundings of one entry of an elimination, generously.

Where contacts hold a body fast, delta_q is a small number or 0, and that bound is next to nothing:
yet it is what is left of the unconstrained step H^-1 g when the contacts have taken theirs, and a
solver that does not know that beforehand rounds both. So no answer is required to be nearer than a
few roundings of it, in the norm in which the package measures every error,

.. math:: \|x - x^*\|_H \le 8 \cdot 2^{-53}\,\|H^{-1} g\|_H,

which moves an entry of x by as many sqrt((H^-1)_vv) at most, one of A'lam = H x - g by sqrt(H_vv),
and a slack by sqrt((A H^-1 A')_ii).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt
from typing import Any

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.form import ExactForm, fraction
from quasistatic_ref.certify.working_set import fraction_point
from quasistatic_ref.lab.vectors.exact.rational import UNIT, inverse, largest, rationals

ROUNDINGS = 8
"""c is that many times the size of K; of the unconstrained step: an answer of 15 digits."""
BITS = 64
"""Of a square root, which is rounded up."""


@dataclass(frozen=True)
class Bounds:
    """Largest error of an entry of each part of an answer.

    Parameters
    ----------
    x : Fraction
        [m, rad].
    lam : Fraction
        [N s].
    net : Fraction
        Of A'lam [N s, N m s].
    slack : Fraction
        [m].
    """

    x: Fraction
    lam: Fraction
    net: Fraction
    slack: Fraction


def bounds(form: ExactForm, working: Sequence[int]) -> Bounds:
    """The bounds of a program at its optimum.

    Parameters
    ----------
    form : ExactForm
        In which y is lam.
    working : sequence of int
        Independent rows that the optimum follows from.
    """
    n = form.n
    size = form.n + len(working)
    H, A, g, c = map(rationals, (form.H, form.A, form.g, form.c))
    g, b = g[:, 0], -c[:, 0]
    solution = fraction_point(form, working)
    rows = list(working)
    numbers = (solution.x, solution.y)
    x, lam = (np.abs(rationals(solution.in_fractions(v))) for v in numbers)
    K = np.block([[H, -A[rows].T], [A[rows], np.zeros((len(rows),) * 2, dtype=int)]])
    share = fmpq(ROUNDINGS * size, UNIT.denominator)
    residual = share * (np.abs(K) @ np.append(x, lam) + np.abs(np.append(g, b[rows])))
    away = np.abs(inverse(K)) @ residual

    def image(M: Any, v: Any) -> Any:
        """Error of M x - v: from that of x, and from the rounding of its own sum."""
        return share * (np.abs(M) @ x + np.abs(v)) + np.abs(M) @ away[:n]

    x_floor, net_floor, slack_floor = floors(form)
    net = max(largest(image(H, g)), net_floor)
    # Multipliers that change A'lam by no more than that are as good.
    steepest = largest(A)
    return Bounds(
        x=max(largest(away[:n]), x_floor),
        lam=max(largest(away[n:]), net / steepest if steepest else Fraction(0)),
        net=net,
        slack=max(largest(image(A, b)), slack_floor),
    )


def floors(form: ExactForm) -> tuple[Fraction, Fraction, Fraction]:
    """Errors of the largest entry of x [m, rad], of A'lam [N s, N m s] and of the slacks [m].

    Parameters
    ----------
    form : ExactForm
    """
    H, A, g = map(rationals, (form.H, form.A, form.g))
    h = fraction(form.h)
    H_inverse = inverse(H)
    energy = ROUNDINGS**2 * (g[:, 0] @ H_inverse @ g[:, 0])
    slacks = np.sum((A @ H_inverse) * A, axis=1)
    squares = (np.diag(H_inverse), np.diag(H) / h**2, slacks)
    x, net, slack = (UNIT * _root(largest(v * energy)) for v in squares)
    return x, net, slack


def _root(value: Fraction) -> Fraction:
    """A square root, rounded up; 0 of 0."""
    p = value.numerator
    q = value.denominator
    return Fraction(isqrt((p * q << 2 * BITS) - 1) + 1, q << BITS) if p else Fraction(0)
