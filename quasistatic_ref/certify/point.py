"""The minimiser on a working set, with every sign that is asked of it decided exactly.

A sign is read from balls where they show it, from an exact linear dependence where a row is one,
and from the rational solution of the KKT system otherwise. The last is the dearest, and kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flint import arb, fmpq, fmpz, fmpz_mat

from quasistatic_ref.certify.balls import BallForm, Balls, equality_solution
from quasistatic_ref.certify.dependence import combinations
from quasistatic_ref.certify.rational import ExactForm


@dataclass(frozen=True, eq=False)
class Rational:
    """A solution of H x = g + A_w' lam, A_w x = b_w: fractions of one positive denominator.

    Parameters
    ----------
    x, lam, slack : list of fmpz
        Numerators; ``slack`` is A x - b for all m rows.
    denominator : fmpz
    """

    x: list[fmpz]
    lam: list[fmpz]
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
    numerators, denominator = K.solve(right).numer_denom()
    if denominator < 0:
        numerators, denominator = numerators * -1, -denominator
    entries = numerators.entries()
    slack = form.A * fmpz_mat(n, 1, entries[:n]) - form.b * denominator
    return Rational(entries[:n], entries[n:], slack.entries(), denominator)


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
        self._dependent: dict[int, int] = {}  # row -> sign of its slack

    @cached_property
    def balls(self) -> Balls | None:
        """Balls around x, the multipliers and the slacks; None if they show nothing."""
        return equality_solution(self.ball_form, self.working)

    @cached_property
    def rational(self) -> Rational:
        """The same without rounding: milliseconds, so only where it is needed."""
        return rational_solution(self.form, self.working)

    @property
    def was_solved_exactly(self) -> bool:
        """Whether the rational solution was needed."""
        return "rational" in self.__dict__

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
        """Signs of all slacks that come without the rational solution; None where unknown."""
        signs: list[int | None] = [None] * self.form.m
        if self.balls is not None:
            signs = [_ball_sign(ball) for ball in self.balls.slack.entries()]
        for i in self.working:
            signs[i] = 0
        return signs

    def decide_slacks(self) -> list[int]:
        """Return the exact signs of all slacks."""
        signs = self.slack_signs
        open_ = [i for i, sign in enumerate(signs) if sign is None]
        if not open_:
            return [sign or 0 for sign in signs]
        for i, c in zip(open_, combinations(self.form, self.working, open_), strict=True):
            if c is not None:  # a_i = sum c_j a_j, so its slack is sum c_j b_j - b_i
                b = self.form.b
                total = sum(
                    (c_j * b[j, 0] for c_j, j in zip(c, self.working, strict=True)), fmpq(0)
                )
                signs[i] = _sign(total - b[i, 0])
        for i in open_:
            if signs[i] is None:
                signs[i] = _sign(self.rational.slack[i])
        return [sign or 0 for sign in signs]


def _sign(x: fmpz | fmpq) -> int:
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
