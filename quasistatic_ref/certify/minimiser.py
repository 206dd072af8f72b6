"""The proof of a right guess: the minimiser on a working set W, and every sign at it.

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

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, TypeVar, cast

import numpy as np
from flint import arb, arb_mat, ctx, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.dependence import follow
from quasistatic_ref.certify.form import (
    EXACT,
    PRECISION,
    TINY,
    UNIT,
    ExactForm,
    columns,
    exact_matrix,
    fraction,
    whole_numbers,
)
from quasistatic_ref.certify.rounding import nearest, nearest_in
from quasistatic_ref.step.data import Array, Indices

Number = TypeVar("Number", arb, fmpz)
Numbers = Callable[["Solution[arb] | Solution[fmpz]"], "list[arb]"]
"""Some numbers of a solution, times its denominator."""

GRID = 2520.0
"""Coefficients of combinations are guessed as fractions of it, which all numbers up to 10 divide:
in a contact they are -1, -1/2 .. 1, and where symmetric contacts share a load thirds and fifths."""
LARGEST = 64.0 * GRID
"""A guess is below it."""


@dataclass(frozen=True, eq=False)
class Solution(Generic[Number]):
    """The solution of H x = g + A_W'y, A_W x + c_W = 0, as numerators and a denominator.

    Parameters
    ----------
    z : arb_mat
        [x; 1] times the denominator, shape (n + 1, 1).
    y : list of arb, or of fmpz
        Times the denominator, in the order of W: balls, or integers.
    denominator : arb
        Exact and positive: 1 in balls.
    """

    z: arb_mat
    y: list[Number]
    denominator: arb

    @property
    def x(self) -> list[arb]:
        """Numerators of x."""
        return self.z.entries()[:-1]

    def in_fractions(self, numerators: Iterable[arb]) -> list[fmpq]:
        """Some numbers of a solution in fractions."""
        denominator = fraction(self.denominator)
        return [fraction(v) / denominator for v in numerators]

    @property
    def point(self) -> list[fmpq]:
        """X of a solution in fractions."""
        return self.in_fractions(self.x)

    @property
    def multipliers(self) -> list[arb]:
        """Numerators of y."""
        return [arb(v) for v in self.y]


def ball_solution(form: ExactForm, working: Sequence[int]) -> Solution[arb]:
    """The solution in balls.

    Raises
    ------
    ZeroDivisionError
        If these do not show that the rows are independent.
    """
    rows = form.exact_rows(working)
    with ctx.workprec(PRECISION):
        S = arb_mat(len(rows), len(rows))
        left = -columns(rows, slice(form.n, form.n + 1))
        pulls = []
        for block, x in zip(form.blocks, form.free, strict=True):
            A = columns(rows, block.of)
            pull = block.inverse * A.transpose()
            S += A * pull
            left -= A * x
            pulls.append(pull)
        y = S.solve(left) if rows else left
        parts = [x + pull * y for x, pull in zip(form.free, pulls, strict=True)]
        z = [v for part in parts for v in part.entries()] + [arb(1)]
    return Solution(arb_mat(form.n + 1, 1, z), y.entries(), arb(1))


def fraction_solution(form: ExactForm, working: Sequence[int]) -> Solution[fmpz]:
    """The solution without rounding; ZeroDivisionError if the rows are not independent."""
    n = form.n
    k = len(working)
    rows = form.exact_rows(working)
    equations = []
    for block in form.blocks:
        before = [arb(0)] * block.of.start
        after = [arb(0)] * (n - block.of.stop)
        table = zip(block.H.tolist(), range(n)[block.of], block.g.entries(), strict=True)
        for row, v, right in table:
            pull = [a[v] for a in rows]  # times -y: negation would round
            equations.append(whole_numbers([*before, *row, *after, *pull, right]))
    for a in rows:
        *a_x, c = whole_numbers(a)
        equations.append([*a_x, *[fmpz(0)] * k, -c])
    K = fmpz_mat(n + k, n + k, [v for row in equations for v in row[:-1]])
    right_side = fmpz_mat(n + k, 1, [row[-1] for row in equations])
    numerators, denominator = cast("fmpq_mat", K.solve(right_side)).numer_denom()  # positive
    entries = numerators.entries()
    z = arb_mat(n + 1, 1, [*entries[:n], denominator])
    return Solution(z, [-v for v in entries[n:]], arb(denominator))


def in_balls(exact: Solution[fmpz]) -> Solution[arb]:
    """A solution in fractions as balls."""
    with ctx.workprec(PRECISION):
        z = exact.z / exact.denominator
        y = [arb(v) / exact.denominator for v in exact.y]
    return Solution(z, y, arb(1))


class Minimiser:
    """The minimiser of a program under a_i x + c_i = 0 for i in W.

    Parameters
    ----------
    form : ExactForm
    working : tuple of int
        W: independent rows.
    balls : Solution, optional
        That on W in balls, where it is known.
    """

    def __init__(
        self, form: ExactForm, working: tuple[int, ...], balls: Solution[arb] | None = None
    ) -> None:
        self.form = form
        self.working = working
        self._balls = balls

    def on(self, working: tuple[int, ...]) -> Minimiser:
        """Return the minimiser of the same form on another working set."""
        return Minimiser(self.form, working)

    @cached_property
    def balls(self) -> Solution[arb]:
        """The solution in balls: by the system of multipliers, or from the fractions.

        The inverses of blocks have a radius, so that a finer system would not help where theirs is
        too wide to show that the rows are independent.
        """
        if self._balls is not None:
            return self._balls
        try:
            return ball_solution(self.form, self.working)
        except ZeroDivisionError:
            return in_balls(self.fractions)

    @cached_property
    def fractions(self) -> Solution[fmpz]:
        """The solution in fractions: milliseconds, so only where it is needed."""
        return fraction_solution(self.form, self.working)

    def multiplier_sign(self, j: int) -> int:
        """Return the exact sign of the multiplier of working[j]."""
        ball = self.balls.y[j]
        return _sign(ball if ball > 0 or ball < 0 else self.fractions.y[j])

    def positive(self) -> tuple[int, ...]:
        """Return the rows of the working set whose multipliers are positive."""
        return tuple(i for j, i in enumerate(self.working) if self.multiplier_sign(j) > 0)

    @cached_property
    def float_slacks(self) -> tuple[Array, Array]:
        """All slacks in float64, and bounds of their errors, each shape (m,)."""
        x = np.array([float(v) for v in self.balls.x])
        off = np.array([float(v.rad()) for v in self.balls.x])
        # float(v) is off by UNIT |x|, or next to nothing; radii are rounded, which 4 makes good.
        with np.errstate(over="ignore", invalid="ignore"):
            return self.form.float_slacks(x, np.abs(x) + 4.0 * off / UNIT + TINY)

    @cached_property
    def open_rows(self) -> list[int]:
        """The rows outside of W whose slacks float64 does not show to be positive."""
        slack, error = self.float_slacks
        is_open = ~(slack > error)
        is_open[list(self.working)] = False
        return np.flatnonzero(is_open).tolist()

    @property
    def lowest_shown(self) -> list[int]:
        """The rows outside of W that float64 shows to be violated, and that may be so most."""
        slack, error = self.float_slacks
        violated = slack < -error
        violated[list(self.working)] = False
        rows = np.flatnonzero(violated)
        least = (slack[rows] + error[rows]).min(initial=np.inf)
        return [int(i) for i in rows[slack[rows] - error[rows] <= least]]

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
        with ctx.workprec(PRECISION):
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
            (slack,) = self.form.slacks([i], self.fractions.z)
        return slack

    def below(self, i: int, j: int) -> bool:
        """Whether the slack of row i is smaller than that of row j, decided exactly."""
        with ctx.workprec(PRECISION):
            one, other = self.form.slacks([i, j], self.balls.z)
            difference = one - other
        if not (difference > 0 or difference < 0 or difference.is_zero()):
            if small_combinations(self.form, self.working, [i, j], np.array([[1.0, -1.0]]))[0]:
                return False
            with ctx.workprec(EXACT):
                difference = self._exact_slack(i) - self._exact_slack(j)
        return bool(difference < 0)

    @cached_property
    def unspanned(self) -> list[int]:
        """The other rows outside of W whose slacks are zero, in increasing order."""
        return [i for i, sign in self.slack_signs.items() if sign == 0]

    @cached_property
    def inactive(self) -> Indices:
        """The rows whose slacks are not zero."""
        is_active = np.zeros(self.form.m, dtype=bool)
        is_active[[*self.working, *self.spanned, *self.unspanned]] = True
        return np.flatnonzero(~is_active)

    def pull(self, found: Solution[arb] | Solution[fmpz]) -> list[arb]:
        """Numerators of A_W'y."""
        rows = self.form.exact_rows(self.working)
        A = columns(rows, slice(0, self.form.n))
        return (A.transpose() * arb_mat(len(rows), 1, found.y)).entries()

    def rounded(self, numbers: Numbers, unit: arb | None = None) -> Array:
        """Numbers of the solution over a unit, each rounded correctly, shape (k,).

        From their balls; where a ball holds numbers of different rounding, from the fractions.
        """
        with ctx.workprec(PRECISION):
            balls = numbers(self.balls)
            balls = balls if unit is None else [ball / unit for ball in balls]
            values = [nearest_in(ball) for ball in balls]
        if None not in values:
            return np.array(values, dtype=np.float64)
        exact = self.fractions
        with ctx.workprec(EXACT):
            below = exact.denominator if unit is None else exact.denominator * unit
            return rounded_quotients(numbers(exact), below)

    def rounded_slacks(self) -> Array:
        """All slacks, shape (m,) [m]."""
        slack = np.zeros(self.form.m)
        slack[self.inactive] = self._slacks_of(self.inactive)
        return slack

    def smallest_slack(self) -> float | None:
        """The smallest slack that is not zero, rounded [m]; None if there is none.

        Rounding keeps the order, so it is the least of the rounded ones: of those that float64 and
        its bound leave the chance to be it.
        """
        if not self.inactive.size:
            return None
        slack, error = (numbers[self.inactive] for numbers in self.float_slacks)
        near = self.inactive[~(slack - error > (slack + error).min())]
        return float(self._slacks_of(near).min())

    def _slacks_of(self, rows: Indices) -> Array:
        return self.rounded(lambda found: self.form.slacks(rows.tolist(), found.z))


def rounded_quotients(numerators: Iterable[arb], denominator: arb) -> Array:
    """Exact numbers over one that is positive, each rounded correctly, shape (k,)."""
    pairs = (whole_numbers([p, denominator]) for p in numerators)
    return np.array([nearest(int(p), int(q)) for p, q in pairs], dtype=np.float64)


def small_combinations(
    form: ExactForm, working: Sequence[int], some: Sequence[int], weights: Array
) -> list[bool]:
    """Which sums of rows [a, c] are seen to be combinations of those of W.

    Coefficients are guessed among fractions of GRID by least squares. A guess counts if what is
    left of the sum, times GRID, is zero without rounding.

    Parameters
    ----------
    form : ExactForm
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
    guess = np.rint(GRID * np.linalg.lstsq(rows[:k].T, sums.T)[0].T)
    good = np.flatnonzero((np.abs(guess) < LARGEST).all(axis=1))
    if good.size:
        with ctx.workprec(EXACT):
            exact = arb_mat(form.exact_rows([*working, *some]))
            left = (exact_matrix(np.hstack([guess[good], -GRID * weights[good]])) * exact).tolist()
        shown[good] = [all(v.is_zero() for v in row) for row in left]
    return shown.tolist()


def _sign(number: arb | fmpz) -> int:
    return int(number > 0) - int(number < 0)
