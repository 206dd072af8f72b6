"""The minimiser on a working set, with every sign that is asked of it decided exactly.

A sign is read from balls where they show it, from an exact linear dependence where a row is one,
and from the rational solution of the KKT system otherwise. The last is the dearest, and kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

from flint import arb, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.balls import BallForm, Balls, equality_solution
from quasistatic_ref.certify.dependence import implied
from quasistatic_ref.certify.rational import ExactForm


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
    numerators, denominator = cast("fmpq_mat", K.solve(right)).numer_denom()
    if denominator < 0:
        numerators, denominator = numerators * -1, -denominator
    entries = numerators.entries()
    x, lam = fmpz_mat(n, 1, entries[:n]), entries[n:]
    net, slack = form.H * x - form.g * denominator, form.A * x - form.b * denominator
    return Rational(x.entries(), lam, net.entries(), slack.entries(), denominator)


class Point:
    """The minimiser x of 1/2 x'Hx - g'x under A_i x = b_i for i in the working set.

    Parameters
    ----------
    form : ExactForm
    balls : BallForm
    working : tuple of int
        Independent rows.
    """

    def __init__(self, form: ExactForm, balls: BallForm, working: tuple[int, ...]) -> None:
        self.form, self.ball_form, self.working = form, balls, working
        self._implied: dict[int, bool] = {}

    @cached_property
    def balls(self) -> Balls | None:
        """Balls around x, the multipliers and the slacks; None if they show nothing."""
        return equality_solution(self.ball_form, self.working)

    @cached_property
    def rational(self) -> Rational:
        """The same without rounding: milliseconds, so only where it is needed."""
        return rational_solution(self.form, self.working)

    def lam_ball(self, j: int) -> arb | None:
        """Return the ball of a multiplier."""
        return None if self.balls is None else self.balls.lam[j]

    def lam_sign(self, j: int) -> int:
        """Return the exact sign of the multiplier of working[j]."""
        shown = _ball_sign(self.lam_ball(j))
        return _sign(self.rational.lam[j]) if shown is None else shown

    def lam_surely_positive(self, j: int) -> bool:
        """Return whether its ball shows the multiplier of working[j] to be positive."""
        return _ball_sign(self.lam_ball(j)) == 1

    @cached_property
    def slack_signs(self) -> list[int | None]:
        """Signs of all slacks as the balls show them: 1, -1, or None where they do not."""
        if self.balls is None:
            return [None] * self.form.m
        return [_ball_sign(ball) or None for ball in self.balls.slack]

    @cached_property
    def decided_slack_signs(self) -> list[int]:
        """Exact signs of all slacks."""
        signs = list(self.slack_signs)
        for i in self.working:
            signs[i] = 0
        for i in self.spanned([i for i, sign in enumerate(signs) if sign is None]):
            signs[i] = 0
        return [_sign(self.rational.slack[i]) if s is None else s for i, s in enumerate(signs)]

    def spanned(self, rows: Sequence[int]) -> list[int]:
        """Return those of some rows whose slack is zero because the working set implies it."""
        new = [i for i in rows if i not in self._implied]
        equations = [[*self.form.row(i), self.form.b[i, 0]] for i in new]
        if new:
            self._implied.update(zip(new, implied(self.form, self.working, equations), strict=True))
        return [i for i in rows if self._implied[i]]

    def zero_coordinates(self, coordinates: Sequence[int]) -> list[int]:
        """Return those of some coordinates in which the working set implies that x is zero."""
        n = self.form.n
        units = [[fmpz(int(i == v)) for i in range(n + 1)] for v in coordinates]
        zero = implied(self.form, self.working, units) if units else []
        return [v for v, is_zero in zip(coordinates, zero, strict=True) if is_zero]


def _sign(x: fmpz) -> int:
    return (x > 0) - (x < 0)


def _ball_sign(ball: arb | None) -> int | None:
    """Return the sign that a ball shows, or None."""
    if ball is None:
        return None
    if ball > 0:
        return 1
    if ball < 0:
        return -1
    return 0 if ball.is_zero() else None
