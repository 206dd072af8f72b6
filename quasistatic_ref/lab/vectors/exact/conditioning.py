r"""What a careful float64 solver can reach on one quadratic program: the tolerances of its answer.

On the working set W the optimum solves K z = r, with K = [[H, -A_w'], [A_w, 0]], z = [x; lam] and
r = [g; b_w]. Data and elimination that are rounded componentwise leave

.. math:: |z - z^*| \le c\,2^{-53}\,|K^{-1}|\,(|K|\,|z^*| + |r|),

the bound of Oettli and Prager (1964) with the condition of Skeel (1979): scaling rows or columns
does not change it. c counts the roundings of one entry of an elimination, generously. No answer is
required to be nearer than :mod:`quasistatic_ref.lab.vectors.exact.floor` says.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, cast

from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.point import rational_solution
from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.lab.vectors.exact.floor import floors
from quasistatic_ref.lab.vectors.exact.rational import UNIT, fraction

ROUNDINGS: Final = 8
"""c is that many times the size of K."""


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


@dataclass(frozen=True)
class Errors:
    """Largest error of an entry of H, g, A and b before the program is solved, in SI units."""

    H: Fraction = Fraction(0)
    g: Fraction = Fraction(0)
    A: Fraction = Fraction(0)
    b: Fraction = Fraction(0)


NO_ERRORS: Final = Errors()


def bounds(form: ExactForm, working: Sequence[int], errors: Errors = NO_ERRORS) -> Bounds:
    """The bounds of a program at its optimum.

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        Independent rows that the optimum follows from.
    errors : Errors
        Of a program that was formed from other numbers; none by default.
    """
    n, k = form.n, len(working)
    solution = rational_solution(form, tuple(working))
    K = fmpz_mat(n + k, n + k)
    for i in range(n):
        for j in range(n):
            K[i, j] = form.H[i, j]
        for row, w in enumerate(working, start=n):
            K[i, row], K[row, i] = -form.A[w, i], form.A[w, i]
    right = _column([form.g[i, 0] for i in range(n)] + [form.b[w, 0] for w in working])
    z = _absolute(_column([*solution.x, *solution.lam]))
    size = _absolute(K) * z + _absolute(right) * solution.denominator
    inverse, denominator = cast("fmpq_mat", K.inv()).numer_denom()
    share = fmpq(ROUNDINGS * (n + k), UNIT.denominator)
    x_sum, lam_sum = (_total(v, solution.denominator) for v in (solution.x, solution.lam))
    balance, shift = _shifts(form, errors, x_sum, lam_sum)
    residual = [
        share * s / solution.denominator + (balance if i < n else shift)
        for i, s in enumerate(size.entries())
    ]
    away = fmpq_mat(_absolute(inverse)) * fmpq_mat(n + k, 1, residual) / abs(denominator)
    moved = away.entries()
    net_shift = _rational(errors.H) * x_sum * form.x_unit + _rational(errors.g)
    net = _largest(_image(form.H, form.g, moved[:n], solution, share), form.net_unit)
    net += _largest([net_shift], fmpq(1))
    x_floor, net_floor, slack_floor = floors(form)
    net = max(net, net_floor)
    slacks = [v + shift for v in _image(form.A, form.b, moved[:n], solution, share)]
    # Multipliers that change A'lam by no more than that are as good.
    steepest = _largest(form.A.entries(), form.slack_unit / form.x_unit)
    return Bounds(
        x=max(_largest(moved[:n], form.x_unit), x_floor),
        lam=max(_largest(moved[n:], form.lam_unit), net / steepest if steepest else Fraction(0)),
        net=net,
        slack=max(_largest(slacks, form.slack_unit), slack_floor),
    )


def _shifts(form: ExactForm, errors: Errors, x_sum: fmpq, lam_sum: fmpq) -> tuple[fmpq, fmpq]:
    """Errors of H x - A'lam - g and of A x - b in units of the form."""
    x, lam = x_sum * form.x_unit, lam_sum * form.lam_unit
    balance = _rational(errors.H) * x + _rational(errors.A) * lam + _rational(errors.g)
    return balance / form.net_unit, (
        _rational(errors.A) * x + _rational(errors.b)
    ) / form.slack_unit


def _rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _total(values: Sequence[fmpz], denominator: fmpz) -> fmpq:
    return fmpq(sum((abs(v) for v in values), start=fmpz(0)), denominator)


def _image(M: fmpz_mat, v: fmpz_mat, dx: list[fmpq], solution: Any, share: fmpq) -> list[fmpq]:
    """Error of M x - v: from that of x, and from the rounding of its own sum."""
    size = _absolute(M) * _absolute(_column(solution.x)) + _absolute(v) * solution.denominator
    own = [share * s / solution.denominator for s in size.entries()]
    return [
        own_i + sum((abs(M[i, j]) * d for j, d in enumerate(dx)), start=fmpq(0))
        for i, own_i in enumerate(own)
    ]


def _column(values: Sequence[Any]) -> fmpz_mat:
    return fmpz_mat(len(values), 1, list(values))


def _absolute(M: fmpz_mat) -> fmpz_mat:
    return fmpz_mat(M.nrows(), M.ncols(), [abs(v) for v in M.entries()])


def _largest(values: Sequence[fmpq | fmpz], unit: fmpq) -> Fraction:
    return fraction(max((abs(unit * v) for v in values), default=fmpq(0)))
