"""The minimiser on a working set, with every sign that is needed decided exactly.

A sign is read from balls where they show it, from an exact linear dependence where a row is one,
and from the rational solution of the KKT system otherwise. That solution takes the
longest to compute, and is kept for the next sign.
"""

from collections.abc import Sequence
from functools import cached_property

from flint import arb, fmpz

from quasistatic_ref.certify.balls import BallForm, Balls, equality_solution
from quasistatic_ref.certify.dependence import implied
from quasistatic_ref.certify.kkt import Rational, rational_solution
from quasistatic_ref.certify.rational import ExactForm


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
        equations = [self.form.equation(i) for i in new]
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
