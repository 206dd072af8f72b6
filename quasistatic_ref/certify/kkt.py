"""The KKT system of a working set, solved without rounding."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from flint import fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.certify.rounding import nearest_fraction
from quasistatic_ref.step.data import Array


@dataclass(frozen=True, eq=False)
class Rational:
    """A solution of H x = g + A_w' lam, A_w x = b_w: fractions of one positive denominator.

    Parameters
    ----------
    x, lam, net, slack : list of fmpz
        Numerators; ``net`` is A_w' lam, ``slack`` is A x - b for all m rows.
    denominator : fmpz
    """

    x: list[fmpz]
    lam: list[fmpz]
    net: list[fmpz]
    slack: list[fmpz]
    denominator: fmpz


def rational_solution(form: ExactForm, working: tuple[int, ...]) -> Rational:
    """The minimiser under A_i x = b_i for i in a working set, without rounding.

    Raises
    ------
    ZeroDivisionError
        If the rows are not independent.
    """
    n, k = form.n, len(working)
    K = fmpz_mat(n + k, n + k)
    right = fmpz_mat(n + k, 1)
    for i in range(n):
        right[i, 0] = form.g[i, 0]
        for j in range(n):
            K[i, j] = form.H[i, j]
    for row, i in enumerate(working, start=n):
        right[row, 0] = form.b[i, 0]
        for j in range(n):
            K[row, j] = form.A[i, j]
            K[j, row] = -form.A[i, j]
    numerators, denominator = cast("fmpq_mat", K.solve(right)).numer_denom()  # positive
    entries = numerators.entries()
    x, lam = fmpz_mat(n, 1, entries[:n]), entries[n:]
    net, slack = form.H * x - form.g * denominator, form.A * x - form.b * denominator
    return Rational(x.entries(), lam, net.entries(), slack.entries(), denominator)


def rounded_solution(form: ExactForm, solution: Rational) -> tuple[Array, Array, Array, Array]:
    """Float64 numbers, rounded correctly.

    Returns
    -------
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (working,)
        On the working set [N s].
    net : ndarray, shape (n_v,)
        A'lam [N s, N m s].
    slack : ndarray, shape (m,)
    """
    x, lam, net, slack = (
        np.array([nearest_fraction(unit * v / solution.denominator) for v in values])
        for unit, values in (
            (form.x_unit, solution.x),
            (form.lam_unit, solution.lam),
            (form.net_unit, solution.net),
            (form.slack_unit, solution.slack),
        )
    )
    return x, lam, net, slack
