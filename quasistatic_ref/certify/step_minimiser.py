"""The proof of a right guess: the minimiser of a step on a working set, and every sign at it.

A sign is taken from the cheapest source that shows it, in this order:

1. float64 with a bound of its error shows most slacks to be positive (``open_rows`` are the rest);
2. a slack is zero if its row is a combination of rows of W with small coefficients: they are
   guessed in float64, and the combination is formed without rounding (``guessed``);
3. balls show the slacks that are clearly not zero (``ball_slacks``);
4. what they leave open is zero if the row follows from those of W, modulo a prime, then in
   integers (``spanned``);
5. the rest is decided by the solution in fractions (``slack_signs``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, TypeVar, cast

import numpy as np
from flint import arb, arb_mat, ctx, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.dependence import follow
from quasistatic_ref.certify.form import (
    EXACT,
    PRECISION,
    TINY,
    UNIT,
    StepForm,
    columns,
    exact_matrix,
    whole_numbers,
)
from quasistatic_ref.certify.rounding import nearest, nearest_in
from quasistatic_ref.step.data import Array

Number = TypeVar("Number", arb, fmpz)


@dataclass(frozen=True, eq=False)
class Solution(Generic[Number]):
    """The solution of K x = w (load + A_W'f), A_W x + c_W = 0, as numerators and a denominator.

    Parameters
    ----------
    z : arb_mat
        [x; 1] times the denominator, shape (n + 1, 1).
    lam : list of arb, or of fmpz
        f times the denominator, in the order of W: balls, or integers.
    net : list of arb
        A_W'f times the denominator.
    denominator : arb
        Exact and positive: 1 in balls.
    bits : int
        The precision at which sums with these numbers are formed.
    """

    z: arb_mat
    lam: list[Number]
    net: list[arb]
    denominator: arb
    bits: int


def ball_solution(form: StepForm, working: Sequence[int], bits: int = PRECISION) -> Solution[arb]:
    """The solution in balls of `bits` bits.

    Raises
    ------
    ZeroDivisionError
        If these do not show that the rows are independent.
    """
    rows = form.exact_rows(working)
    A = [columns(rows, block.of) for block in form.blocks]
    with ctx.workprec(bits):
        S = arb_mat(len(rows), len(rows))
        left = -columns(rows, slice(form.n, form.n + 1))
        pulled = []
        for B, block, x in zip(A, form.blocks, form.free, strict=True):
            Y = block.inverse * B.transpose() * block.weight
            S += B * Y
            left -= B * x
            pulled.append(Y)
        f = S.solve(left) if rows else left
        parts = [x + Y * f for x, Y in zip(form.free, pulled, strict=True)]
        net = [v for B in A for v in (B.transpose() * f).entries()]
        z = [v for part in parts for v in part.entries()] + [arb(1)]
    return Solution(arb_mat(form.n + 1, 1, z), f.entries(), net, arb(1), bits)


def fraction_solution(form: StepForm, working: Sequence[int]) -> Solution[fmpz]:
    """The solution without rounding; ZeroDivisionError if the rows are not independent."""
    n, k = form.n, len(working)
    rows = form.exact_rows(working)
    equations = []
    with ctx.workprec(EXACT):
        for block in form.blocks:
            pull = (-columns(rows, block.of).transpose() * block.weight).tolist()
            right = (block.load * block.weight).entries()
            before = [arb(0)] * block.of.start
            after = [arb(0)] * (n - block.of.stop)
            for i, row in enumerate(block.K.tolist()):
                on_f = pull[i] if k else []
                equations.append(whole_numbers([*before, *row, *after, *on_f, right[i]]))
        for row in rows:
            equations.append(whole_numbers([*row[:-1], *[arb(0)] * k, -row[-1]]))
        K = fmpz_mat(n + k, n + k, [v for row in equations for v in row[:-1]])
        right_side = fmpz_mat(n + k, 1, [row[-1] for row in equations])
        numerators, denominator = cast("fmpq_mat", K.solve(right_side)).numer_denom()  # positive
        entries = numerators.entries()
        f = arb_mat(k, 1, entries[n:])
        blocks = [columns(rows, block.of).transpose() * f for block in form.blocks]
        net = [v for part in blocks for v in part.entries()]
    z = arb_mat(n + 1, 1, [*entries[:n], denominator])
    return Solution(z, entries[n:], net, arb(denominator), EXACT)


def in_balls(exact: Solution[fmpz]) -> Solution[arb]:
    """A solution in fractions as balls of ``PRECISION`` bits."""
    with ctx.workprec(PRECISION):
        z = exact.z / exact.denominator
        lam = [arb(v) / exact.denominator for v in exact.lam]
        net = [v / exact.denominator for v in exact.net]
    return Solution(z, lam, net, arb(1), PRECISION)


class StepMinimiser:
    """The minimiser of a step, or of a group of one, under a_i x + c_i = 0 for i in W.

    Parameters
    ----------
    form : StepForm
    working : tuple of int
        W: independent rows.
    balls : Solution, optional
        That on W in balls, where it is known.
    """

    def __init__(
        self, form: StepForm, working: tuple[int, ...], balls: Solution[arb] | None = None
    ) -> None:
        self.form = form
        self.working = working
        self._balls = balls

    def on(self, working: tuple[int, ...]) -> StepMinimiser:
        """Return the minimiser of the same form on another working set."""
        return StepMinimiser(self.form, working)

    @cached_property
    def balls(self) -> Solution[arb]:
        """The solution in balls: by the system of forces, or from the fractions.

        The inverses of blocks have a radius, so that a finer system would not help where theirs is
        too wide to show that the rows are independent.
        """
        if self._balls is not None:
            return self._balls
        try:
            return ball_solution(self.form, self.working)
        except ZeroDivisionError:
            return in_balls(self.rational)

    @cached_property
    def rational(self) -> Solution[fmpz]:
        """The solution in fractions: milliseconds, so only where it is needed."""
        return fraction_solution(self.form, self.working)

    def lam_sign(self, j: int) -> int:
        """Return the exact sign of the multiplier of working[j]."""
        ball = self.balls.lam[j]
        return _sign(ball if ball > 0 or ball < 0 else self.rational.lam[j])

    def positive(self) -> tuple[int, ...]:
        """Return the rows of the working set whose multipliers are positive."""
        return tuple(i for j, i in enumerate(self.working) if self.lam_sign(j) > 0)

    @cached_property
    def float_slacks(self) -> tuple[Array, Array]:
        """All slacks in float64, and bounds of their errors, each shape (m,)."""
        balls = self.balls.z.entries()[:-1]
        x = np.array([float(v) for v in balls])
        off = np.array([float(v.rad()) for v in balls])
        # float(v) is off by UNIT |x|, or next to nothing; radii are rounded, which 4 makes good.
        return self.form.float_slacks(x, np.abs(x) + 4.0 * off / UNIT + TINY)

    @cached_property
    def open_rows(self) -> list[int]:
        """The rows outside of W whose slacks float64 does not show to be positive."""
        slack, error = self.float_slacks
        is_open = ~(slack > error)
        is_open[list(self.working)] = False
        return np.flatnonzero(is_open).tolist()

    @cached_property
    def guessed(self) -> list[int]:
        """The open rows that are small combinations of rows of W: their slacks are zero."""
        weights = np.eye(len(self.open_rows))
        shown = small_combinations(self.form, self.working, self.open_rows, weights)
        return [i for i, is_zero in zip(self.open_rows, shown, strict=True) if is_zero]

    @cached_property
    def ball_slacks(self) -> dict[int, arb]:
        """The slacks of the other open rows in balls."""
        rows = sorted({*self.open_rows} - {*self.guessed})
        with ctx.workprec(self.balls.bits):
            return dict(zip(rows, self.form.slacks(rows, self.balls.z), strict=True))

    @cached_property
    def spanned(self) -> list[int]:
        """The open rows that W implies, in increasing order: their slacks are zero."""
        dark = [i for i, ball in self.ball_slacks.items() if not (ball > 0 or ball < 0)]
        if not dark:
            return self.guessed
        implied = follow(self.form.equations(self.working), self.form.equations(dark))
        return sorted([*self.guessed, *(i for i, so in zip(dark, implied, strict=True) if so)])

    @cached_property
    def slack_signs(self) -> dict[int, int]:
        """The exact signs of the slacks of all open rows that W does not imply."""
        implied = {*self.spanned}
        return {
            i: _sign(ball if ball > 0 or ball < 0 else self._exact_slack(i))
            for i, ball in self.ball_slacks.items()
            if i not in implied
        }

    def _exact_slack(self, i: int) -> arb:
        with ctx.workprec(EXACT):
            (slack,) = self.form.slacks([i], self.rational.z)
        return slack

    def below(self, i: int, j: int) -> bool:
        """Whether the slack of row i is smaller than that of row j, decided exactly."""
        with ctx.workprec(self.balls.bits):
            difference = self.ball_slacks[i] - self.ball_slacks[j]
        if not (difference > 0 or difference < 0):
            if small_combinations(self.form, self.working, [i, j], np.array([[1.0, -1.0]]))[0]:
                return False
            with ctx.workprec(EXACT):
                difference = self._exact_slack(i) - self._exact_slack(j)
        return bool(difference < 0)

    def rounded(self, numbers: Callable[[Solution[arb] | Solution[fmpz]], list[arb]]) -> Array:
        """Numbers of the solution, over its denominator, each rounded correctly, shape (k,).

        From their balls; where a ball holds numbers of different rounding, from the fractions.
        """
        with ctx.workprec(self.balls.bits):
            values = [nearest_in(ball) for ball in numbers(self.balls)]
        if None in values:
            exact = self.rational
            with ctx.workprec(EXACT):
                numerators = numbers(exact)
            pairs = (whole_numbers([p, exact.denominator]) for p in numerators)
            values = [
                nearest(int(p), int(q)) if value is None else value
                for value, (p, q) in zip(values, pairs, strict=True)
            ]
        return np.array(values, dtype=np.float64)


def small_combinations(
    form: StepForm, working: Sequence[int], some: Sequence[int], weights: Array
) -> list[bool]:
    """Which sums of rows [a, c] are seen to be combinations of those of W.

    Coefficients are guessed among halves by least squares. A guess counts if what is left of the
    sum is zero without rounding.

    Parameters
    ----------
    form : StepForm
    working : sequence of int
        W.
    some : sequence of int
        Rows.
    weights : ndarray, shape (k, rows)
        Whole numbers [-]: those of each sum.
    """
    k = len(working)
    shown = np.zeros(len(weights), dtype=bool)
    if not (k and some):
        return shown.tolist()
    rows = form.float_rows([*working, *some])
    if not np.isfinite(rows).all():
        return shown.tolist()
    sums = weights @ rows[k:]
    guess = np.rint(2.0 * np.linalg.lstsq(rows[:k].T, sums.T)[0].T) / 2.0
    good = np.flatnonzero((np.abs(guess) < LARGEST).all(axis=1))
    if good.size:
        with ctx.workprec(EXACT):
            exact = arb_mat(form.exact_rows([*working, *some]))
            left = (exact_matrix(np.hstack([guess[good], -weights[good]])) * exact).tolist()
        shown[good] = [all(v.is_zero() for v in row) for row in left]
    return shown.tolist()


LARGEST = 64.0
"""Coefficients of combinations are guessed below it: in a contact they are -1, -1/2 .. 1."""


def _sign(number: arb | fmpz) -> int:
    return int(number > 0) - int(number < 0)
