"""The minimiser on a working set W, and the exact signs of its multipliers and slacks.

The sign of a slack is taken from the first of these sources that shows it:

1. float64 with a bound of its error shows most to be positive (``open_rows`` are the others);
2. a slack is zero if the geometry of its contact's cone says that W implies its row, whatever the
   numbers are;
3. balls show the others that are clearly not zero (``slack_balls``); a row that they show to be
   violated needs no other sign;
4. of the rest W implies some rows (``implied_rows``), which a prime refutes or few rows prove;
   finer balls of a large program, then fractions, decide the others (``slack_signs``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress
from typing import Final, Protocol, TypeAlias

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz, fmpz_mat

from quasistatic_ref.exact.few_columns import FewColumns, few_columns
from quasistatic_ref.exact.program import (
    EXACT,
    UNDERFLOW,
    UNIT,
    ExactProgram,
    combination,
    fraction,
    null_space,
    rounded_quotients,
    sums,
    sums_of_halves,
    whole_numbers,
)
from quasistatic_ref.exact.working_set import KktPoint, UpdatedInverse, WholeSystem, ball_point
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.modulo import PRIME, supports_modulo
from quasistatic_ref.numbers.precision import all_nearest, working_precision


class Line(Protocol):
    """End values, or directions, of the multipliers on W in a step of the dual method."""

    @property
    def ends(self) -> list[arb]:
        """The end of each multiplier, as balls."""

    def end(self, j: int) -> fmpq:
        """The end of multiplier j as an exact number, scaled by a positive factor common to all."""


@dataclass(frozen=True, eq=False)
class Relation:
    """The u of a_p + sum_j u_j A[working[j]] = 0.

    Parameters
    ----------
    form : ExactProgram
    working : tuple of int
        W.
    p : int
        A row.
    ends : list of arb
        u.
    """

    form: ExactProgram
    working: tuple[int, ...]
    p: int
    ends: list[arb]

    @cached_property
    def exact(self) -> list[fmpq] | None:
        """The u in fractions; None if the row is independent of W.

        Which of them are not zero is guessed from balls, of a large set modulo a prime, and
        elimination proves the guess.
        """
        guess: Sequence[int] | None = [j for j, v in enumerate(self.ends) if not v.contains(0)]
        if len(self.working) > LARGE:
            *held, row = (a[:-1] for a in self.form.whole_rows([*self.working, self.p]))
            supports = supports_modulo(held, [row])
            guess = guess if supports is None else supports[0]
        if guess is None:
            return None
        some = combination(self.form, [self.working[j] for j in guess], self.p)
        if some is None:
            guess = range(len(self.working))
            some = combination(self.form, self.working, self.p)
            if some is None:
                return None
        u = [fmpq(0)] * len(self.working)
        for j, c_j in zip(guess, some, strict=True):
            u[j] = -c_j
        return u

    def end(self, j: int) -> fmpq:
        """The exact u_j of the relation, which is its direction of multiplier j."""
        assert self.exact is not None  # it is a relation
        return self.exact[j]


SMALL: Final = 6
"""Rows of a working set up to which all it implies takes less time than a guess."""
LARGE: Final = 32
"""Rows of a working set above which finer balls and a prime come before whole numbers, whose cost
grows by the fifth power."""
FINEST: Final = 1280
"""Most bits of balls."""

Numbers: TypeAlias = Callable[[KktPoint], "list[arb]"]
"""Some numbers of a solution, times its denominator."""


class Minimiser:
    """The minimiser of a program under a_i x + c_i = 0 for i in W.

    Parameters
    ----------
    form : ExactProgram
    working : tuple of int
        W: independent rows.
    near : UpdatedInverse, optional
        Of a working set that may differ by few rows.
    bits : int, optional
        Of balls; by default those of the form.

    Attributes
    ----------
    is_large : bool
        Whether W has so many rows that fractions are to be avoided.
    iterations : int
        Of an optimum, rows that were added to the warm start.
    """

    iterations = 0

    def __init__(
        self,
        form: ExactProgram,
        working: tuple[int, ...],
        near: UpdatedInverse | None = None,
        bits: int | None = None,
    ) -> None:
        self.form = form
        self.working = working
        self.is_large = len(working) > LARGE
        self.bits = bits or form.bits
        self._near = near if near is not None and near.has_near(working) else None

    def on(self, working: tuple[int, ...]) -> Minimiser:
        """The minimiser on another working set, that differs by few rows."""
        return Minimiser(self.form, working, self.near_sets, self._shown.bits)

    @cached_property
    def finer(self) -> Minimiser | None:
        """The same one, with balls of twice the bits; None where fractions come next."""
        if not self.is_large or 2 * self.bits > FINEST:
            return None
        return Minimiser(self.form, self.working, bits=2 * self.bits)

    @cached_property
    def near_sets(self) -> UpdatedInverse:
        """A solver for multipliers on working sets that differ from this one by few rows."""
        if self._near is not None and self._near_balls is not None:
            return self._near
        bits = self._shown.bits
        try:
            return UpdatedInverse(self.form, self.working, bits)
        except ZeroDivisionError:
            return UpdatedInverse(self.form, (), bits)

    @cached_property
    def _near_balls(self) -> KktPoint | None:
        """The solution in balls by way of a nearby set; None if the balls are too wide.

        They grow with each row by which the sets differ, and more where rows nearly depend on each
        other.
        """
        return self._balls_by(self._near) if self._near else None

    @cached_property
    def _own_balls(self) -> KktPoint | None:
        """The solution in balls of `bits`; None if these are too wide, or do not show one."""
        return self._near_balls or self._balls_by(None)

    def _balls_by(self, near: UpdatedInverse | None) -> KktPoint | None:
        try:
            balls = ball_point(self.form, self.working, self.bits, near)
        except ZeroDivisionError:
            return None
        return None if balls.is_wide else balls

    @cached_property
    def _shown(self) -> Minimiser:
        """The least fine of the same minimisers whose balls show the solution, or the finest."""
        if self._own_balls is not None or self.finer is None:
            return self
        return self.finer._shown

    @cached_property
    def balls(self) -> KktPoint:
        """The solution in balls, by the system of multipliers, or from the fractions.

        H^-1 has a radius, so that a finer system would not help where that is too wide to show x,
        or that the rows are independent: in finer balls H^-1 is formed again.

        Raises
        ------
        ZeroDivisionError
            If the rows are not independent.
        """
        balls = self._shown._own_balls
        if balls is not None:
            return balls
        exact = self.fractions
        with working_precision(self.bits):
            share = 1 / exact.denominator
            y = [v * share for v in exact.y]
            return KktPoint(exact.z * share, y, exact.net * share, arb(1))

    @cached_property
    def _whole(self) -> WholeSystem:
        return WholeSystem(self.form, self.working)

    @cached_property
    def fractions(self) -> KktPoint:
        """The solution in exact fractions, which takes milliseconds."""
        return self._whole.solution()

    @cached_property
    def _modulo(self) -> KktPoint | None:
        """The solution modulo a prime; None if that shows none."""
        try:
            return self._whole.solution_modulo()
        except ZeroDivisionError:
            return None

    @property
    def ends(self) -> list[arb]:
        """The multipliers of this minimiser, as balls: the ends of a :class:`Line`."""
        return self.balls.y

    def end(self, j: int) -> fmpq:
        """Multiplier j of this minimiser as a fraction, up to a positive factor common to all."""
        return fraction(self.fractions.y[j])

    def rows_that_bear(self) -> tuple[int, ...]:
        """The rows of the working set that are equations, or whose multipliers are positive."""
        equations = self.form.equations
        return tuple(
            i
            for j, (i, ball) in enumerate(zip(self.working, self.balls.y, strict=True))
            if i < equations or (_sign(ball) or self.multiplier_sign(j)) > 0
        )

    def multiplier_sign(self, j: int) -> int:
        """The exact sign of multiplier j of W."""
        return self.sign(lambda m: m.y[j])

    def slack_sign(self, i: int) -> int:
        """The exact sign of the slack of row i."""
        return self.sign(lambda m: self.form.slacks([i], m.z)[0])

    def sign(self, number: Callable[[KktPoint], arb]) -> int:
        """The exact sign of a number of the solution that its balls leave open.

        From finer balls, if the number is not zero modulo a prime; else from the fractions.
        """
        level = None if self._may_vanish(number) else self.finer
        while level is not None:
            with working_precision(level.bits):
                sign = _sign(number(level.balls))
            if sign:
                return sign
            level = level.finer
        with working_precision(EXACT):
            return _sign(number(self.fractions))

    def _may_vanish(self, number: Callable[[KktPoint], arb]) -> bool:
        """Whether a prime does not show that a number of the solution is not zero."""
        if self.finer is None or self._modulo is None:
            return True
        with working_precision(EXACT):
            (residue,) = whole_numbers([number(self._modulo)])
        return residue % PRIME == 0

    @cached_property
    def float_slacks(self) -> tuple[Array, Array]:
        """All slacks in float64, and bounds of their errors, each shape (m,)."""
        x, off = self.balls.floats
        # float(v) is off by UNIT |x|, or next to nothing; radii are rounded, which 4 makes good.
        with np.errstate(over="ignore", invalid="ignore"):
            return self.form.float_slacks(x, np.abs(x) + 4.0 * off / UNIT + UNDERFLOW)

    @cached_property
    def open_rows(self) -> list[int]:
        """The rows outside of W whose slacks float64 does not show to be positive."""
        slack, error = self.float_slacks
        is_open = ~(slack > error)
        is_open[list(self.working)] = False
        return np.flatnonzero(is_open).tolist()

    @property
    def perhaps_most_violated(self) -> list[int]:
        """Rows outside of W that are violated in float64 and may be the most violated ones."""
        slack, error = self.float_slacks
        violated = slack < -error
        violated[list(self.working)] = False
        rows = np.flatnonzero(violated)
        least = (slack[rows] + error[rows]).min(initial=np.inf)
        return [int(i) for i in rows[slack[rows] - error[rows] <= least]]

    @cached_property
    def null_space(self) -> fmpz_mat:
        """All [x; t] with A_W x + c_W t = 0: a basis, shape (n + 1, d)."""
        return null_space(self.form.integers(self.working), self.form.n + 1)

    def beyond_cones(self, some: Sequence[int]) -> list[int]:
        """The given rows that are not already implied by rows of the same contact."""
        by_cone = {*self.form.implied_by_cone(self.working, some)}
        return [i for i in some if i not in by_cone]

    def implied(self, some: Sequence[int]) -> list[int]:
        """The given rows [a, c] that are linear combinations of rows of W, in ascending order."""
        beyond = self.beyond_cones(some)
        return sorted({*some} - {*beyond} | {*self.in_row_space(beyond)})

    def in_row_space(self, some: list[int]) -> list[int]:
        """Those of the given rows that W implies, whatever the cones of its contacts imply."""
        if not some:
            return []
        if self.is_large:
            return [*compress(some, self._sums(self.form.whole_rows(some)))]
        shown = sums_of_halves(self.form, self.working, some) if len(self.working) > SMALL else []
        others = [i for i in some if i not in shown]
        if others:
            with working_precision(EXACT):
                values = self.form.values(others, arb_mat(self.null_space))
            shown += compress(others, (all(v.is_zero() for v in row) for row in values))
        return shown

    @cached_property
    def _few_columns(self) -> FewColumns | None:
        return few_columns(self.form.whole_rows(self.working), self.form.n + 1)

    def _sums(self, rows: Sequence[Sequence[fmpz]]) -> list[bool]:
        """Which rows of whole numbers are sums of rows of W: for many rows."""
        if rows and self._few_columns is not None:
            return self._few_columns.vanish(rows)
        return sums(self.form.whole_rows(self.working), rows)

    @cached_property
    def slack_balls(self) -> dict[int, arb]:
        """Slacks, as balls, of the open rows that are not implied by rows of the same contact."""
        rows = self.beyond_cones(self.open_rows)
        with working_precision(self.bits):
            return dict(zip(rows, self.form.slacks(rows, self.balls.z), strict=True))

    @cached_property
    def implied_rows(self) -> list[int]:
        """The open rows that W implies, in increasing order: their slacks are zero."""
        balls = self.slack_balls
        by_cone = [i for i in self.open_rows if i not in balls]
        near_zero = [i for i, ball in balls.items() if ball.contains(0)]
        return sorted([*by_cone, *self.in_row_space(near_zero)])

    @cached_property
    def slack_signs(self) -> dict[int, int]:
        """The exact signs of the slacks of all open rows that W does not imply."""
        implied_rows = {*self.implied_rows}
        by_balls = {i: _sign(v) for i, v in self.slack_balls.items() if i not in implied_rows}
        left = [i for i, sign in by_balls.items() if not sign]
        if self.is_large:
            return by_balls | {i: self.slack_sign(i) for i in left}
        return by_balls | {i: _sign(v) for i, v in self.exact_slacks(left).items()}

    def exact_slacks(self, some: Sequence[int]) -> dict[int, arb]:
        """Slacks of the given rows in whole numbers, all times one positive number."""
        if not some:
            return {}
        with working_precision(EXACT):
            return dict(zip(some, self.form.slacks(some, self.fractions.z), strict=True))

    def with_row(self, p: int) -> Minimiser | Relation:
        """The minimiser on W and row p; if row p depends on W, the relation between them."""
        near = self.near_sets
        working = self.working
        try:
            delassus = near.delassus_column(working, p)
            c = near.solved(working, delassus)
        except ZeroDivisionError:
            c = [arb(0, 1)] * len(working)  # nothing is shown
        else:
            a, displacement, *_ = near.response(p)
            with working_precision(self.bits):
                of_others = sum((v * s for v, s in zip(c, delassus, strict=True)), arb(0))
                if (a * displacement)[0, 0] - of_others > 0:
                    return self.on((*working, p))
        relation = Relation(self.form, working, p, [-v for v in c])
        if len(working) == self.form.n or relation.exact is not None:
            return relation
        return self.on((*working, p))

    def slack_is_less(self, i: int, j: int) -> bool:
        """Whether the slack of row i is smaller than that of row j, decided exactly."""

        def difference(point: KktPoint) -> arb:
            one, other = self.form.slacks([i, j], point.z)
            return one - other

        with working_precision(self.bits):
            sign = _sign(difference(self.balls))
        if not sign:
            row_i, row_j = self.form.integers([i, j])
            if all(self._sums([[v - w for v, w in zip(row_i, row_j, strict=True)]])):
                return False
            sign = self.sign(difference)
        return sign < 0

    @cached_property
    def tight_rows(self) -> list[int]:
        """The other rows outside of W whose slacks are zero, in increasing order."""
        return [i for i, sign in self.slack_signs.items() if sign == 0]

    @cached_property
    def inactive(self) -> Indices:
        """The rows whose slacks are not zero."""
        is_active = np.zeros(self.form.m, dtype=bool)
        is_active[[*self.working, *self.implied_rows, *self.tight_rows]] = True
        return np.flatnonzero(~is_active)

    @cached_property
    def with_exact_zeros(self) -> KktPoint:
        """The solution in balls, where each entry of x that W implies to be zero is zero.

        No ball shows that by itself. From it follows what of A_W'y = H x - g is a load alone.
        """
        balls = self.balls
        n = self.form.n
        entries = balls.z.entries()
        if self.is_large:
            still = [j for j, v in enumerate(entries) if v.contains(0)]
            units = [[fmpz(int(i == j)) for i in range(n + 1)] for j in still]
            zero = {*compress(still, self._sums(units))}
            moves = [j not in zero for j in range(n + 1)]
        else:
            moves = [any(row) for row in self.null_space.tolist()]
        if all(moves):
            return balls
        z = arb_mat(n + 1, 1, _chosen(moves, entries, [arb(0)] * (n + 1)))
        with working_precision(self.bits):
            pull = (self.form.H * arb_mat(n, 1, z.entries()[:-1]) - self.form.g).entries()
        net = arb_mat(n, 1, _chosen(moves[:-1], balls.net.entries(), pull))
        return KktPoint(z, balls.y, net, balls.denominator)

    def rounded(self, numbers: Numbers, unit: arb | None = None) -> Array:
        """Numbers of the solution over a unit, each rounded correctly, shape (k,).

        From their balls; where a ball holds numbers of different rounding, from the fractions.
        """
        for settled in (False, True):
            solution = self.with_exact_zeros if settled else self.balls
            with working_precision(self.bits):
                balls = numbers(solution)
                balls = balls if unit is None else [ball / unit for ball in balls]
                values = all_nearest(balls)
            if values is not None:
                return np.array(values, dtype=np.float64)
        exact = self.fractions
        with working_precision(EXACT):
            denominator = exact.denominator if unit is None else exact.denominator * unit
            return rounded_quotients(numbers(exact), denominator)

    def smallest_slack(self) -> float | None:
        """The smallest slack that is not zero, rounded [m]; None if there is none.

        Rounding keeps the order, so it is the least of the rounded ones: of those that float64 and
        its bound leave the chance to be it.
        """
        if not self.inactive.size:
            return None
        slack, error = (numbers[self.inactive] for numbers in self.float_slacks)
        near = self.inactive[~(slack - error > (slack + error).min())].tolist()
        return float(self.rounded(lambda m: self.form.slacks(near, m.z)).min())


def _chosen(where: Sequence[bool], here: Sequence[arb], elsewhere: Sequence[arb]) -> list[arb]:
    """Entries of `here` where the mask is true, and of `elsewhere` where it is false."""
    return [a if first else b for first, a, b in zip(where, here, elsewhere, strict=True)]


def _sign(ball: arb) -> int:
    """The sign of the numbers in a ball, 0 if they differ in sign, or of an exact number."""
    return int(ball > 0) - int(ball < 0)
