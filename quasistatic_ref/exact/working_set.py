r"""The solution of a working set's equations: x and multipliers, in balls or exactly.

On sets that differ by few rows balls share their work. Let G be the inverse of
:math:`S = A H^{-1} A^T` over the rows of one working set, the base. On another one the rows E have
entered and the rows D have left. What S y = r comes to there is :math:`y = G r - U t`: a column of
U for each row of E, :math:`G A H^{-1} a_e^T`, and for each of D its column of G. The few t follow
from the equations of E and from y_D = 0. So a set costs products with columns, where a solution of
its own takes the cube of its size.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat, nmod_mat

from quasistatic_ref.exact.program import EXACT, UNIT, ExactProgram, Row, columns, fraction
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.modulo import PRIME
from quasistatic_ref.numbers.precision import working_precision

FEW_ROWS = 4
"""Rows that may enter and leave a base of any size, beside a quarter of its rows."""


@dataclass(frozen=True, eq=False)
class KktPoint:
    """The x and y of H x = g + A_W'y, A_W x + c_W = 0, as numerators and a denominator.

    Parameters
    ----------
    z : arb_mat
        [x; 1] times the denominator, shape (n + 1, 1): balls, or whole numbers.
    y : list of arb
        Times the denominator, in the order of W.
    net : arb_mat
        A_W'y times the denominator, shape (n, 1).
    denominator : arb
        Exact and positive: 1 in balls.
    least : float
        A radius that shows x well enough, whatever is left of it [m, rad].
    """

    z: arb_mat
    y: list[arb]
    net: arb_mat
    denominator: arb
    least: float = 0.0

    @property
    def x(self) -> list[arb]:
        """Numerators of x."""
        return self.z.entries()[:-1]

    @cached_property
    def floats(self) -> tuple[Array, Array]:
        """Midpoints and radii of the numerators of x, each shape (n,)."""
        x = self.x
        return np.array([float(v) for v in x]), np.array([float(v.rad()) for v in x])

    @property
    def is_wide(self) -> bool:
        """Whether a radius of x is larger than what float64 tells apart of its largest number.

        Where all rests x is next to nothing, and its terms cancel: no radius is small beside that.
        """
        x, radius = self.floats
        return not radius.max(initial=0.0) <= max(UNIT * np.abs(x).max(initial=0.0), self.least)

    def in_fractions(self, numerators: Iterable[arb]) -> list[fmpq]:
        """The given numerators over the point's denominator, as fractions."""
        denominator = fraction(self.denominator)
        return [fraction(v) / denominator for v in numerators]

    @property
    def exact_x(self) -> list[fmpq]:
        """The x of a point in fractions."""
        return self.in_fractions(self.x)


class RowResponse(NamedTuple):
    """The response of the minimiser on a base set to a unit multiplier of one row.

    Parameters
    ----------
    a, displacement : arb_mat
        The row, shape (1, n), and H^-1 a', shape (n, 1).
    delassus, changes : list of arb
        A H^-1 a' and G A H^-1 a' of the rows A of the base.
    """

    a: arb_mat
    displacement: arb_mat
    delassus: list[arb]
    changes: list[arb]


class UpdatedInverse:
    """Solves for the multipliers on a base and on working sets near it.

    Parameters
    ----------
    form : ExactProgram
    base : sequence of int
        Independent rows.
    bits : int
        Of balls.

    Raises
    ------
    ZeroDivisionError
        If balls do not show that they are independent.
    """

    def __init__(self, form: ExactProgram, base: Sequence[int], bits: int) -> None:
        self.form = form
        self._bits = bits
        self._H_inverse = form.inverse(bits).H_inverse
        self._place = {i: place for place, i in enumerate(base)}
        rows = form.exact_rows(base)
        self._A = columns(rows, slice(0, form.n))
        k = len(rows)
        with working_precision(bits):
            one = arb_mat(k, k, [int(i == j) for i in range(k) for j in range(k)])
            self._G = delassus_matrix(form, rows, self._A, bits).solve(one, algorithm="lu")
        self._G_rows = self._G.tolist()
        self._responses: dict[int, RowResponse] = {}

    def has_near(self, working: Sequence[int]) -> bool:
        """Whether a working set differs by few rows."""
        return len({*working} ^ {*self._place}) <= FEW_ROWS + len(self._place) // 4

    def response(self, i: int) -> RowResponse:
        """The response of the base to a unit multiplier of row i."""
        if i not in self._responses:
            a = columns(self.form.exact_rows([i]), slice(0, self.form.n))
            with working_precision(self._bits):
                displacement = self._H_inverse * a.transpose()
                column = self._A * displacement
                changes = (self._G * column).entries()
            self._responses[i] = RowResponse(a, displacement, column.entries(), changes)
        return self._responses[i]

    def delassus_column(self, working: Sequence[int], p: int) -> list[arb]:
        """The vector A_W H^-1 a_p', a column of the Delassus matrix: an entry for each row of W."""
        response = self.response(p)
        place = self._place
        with working_precision(self._bits):
            return [
                response.delassus[place[i]] if i in place else self._between(i, [p])[0]
                for i in working
            ]

    def solved(self, working: Sequence[int], right_side: Sequence[arb]) -> list[arb]:
        """The y of A_W H^-1 A_W' y = r.

        Raises
        ------
        ZeroDivisionError
            If balls do not show that the rows of W are independent.
        """
        right = dict(zip(working, right_side, strict=True))
        place = self._place
        entered = [i for i in working if i not in place]
        left = [j for i, j in place.items() if i not in right]
        y = arb_mat(len(place), 1, [right.get(i, 0) for i in place])
        t: list[arb] = []
        with working_precision(self._bits):
            y = self._G * y
            if entered or left:
                changes = [self._G_rows[j] for j in left] + [
                    self.response(i).changes for i in entered
                ]
                U = arb_mat(changes).transpose()
                loads = [self._unit(j) for j in left] + [self.response(i).delassus for i in entered]
                equations = arb_mat(loads)
                r = [arb(0)] * len(left) + [right[i] for i in entered]
                of_entered = [[arb(0)] * len(left) + self._between(i, entered) for i in entered]
                C = arb_mat([[arb(0)] * len(r)] * len(left) + of_entered)
                few = (C - equations * U).solve(arb_mat(len(r), 1, r) - equations * y)
                y -= U * few
                t = few.entries()[len(left) :]
        multipliers = dict(zip((*place, *entered), (*y.entries(), *t), strict=True))
        return [multipliers[i] for i in working]

    def _unit(self, j: int) -> list[arb]:
        return [arb(int(j == k)) for k in range(len(self._place))]

    def _between(self, i: int, rows: Sequence[int]) -> list[arb]:
        """The a_i H^-1 a' of some rows."""
        a = self.response(i).a
        return [(a * self.response(other).displacement)[0, 0] for other in rows]


def delassus_matrix(form: ExactProgram, rows: Sequence[Row], A: arb_mat, bits: int) -> arb_mat:
    """The Delassus matrix S = A H^-1 A' of exact rows, in balls: by the few blocks that each moves.

    Parameters
    ----------
    form : ExactProgram
    rows : sequence of list of arb
        [a, c].
    A : arb_mat
        Their a, shape (k, n).
    bits : int
    """
    H_inverse, blocks, *_ = form.inverse(bits)
    if not blocks:
        return A * (H_inverse * A.transpose())
    k = len(rows)
    S = [[arb(0)] * k for _ in range(k)]
    moves = np.array([[not v.is_zero() for v in row] for row in rows], dtype=bool).reshape(
        k, form.n + 1
    )
    for at, block in blocks:
        moved = np.flatnonzero(moves[:, at].any(axis=1)).tolist()
        if moved:
            some = arb_mat([[rows[i][v] for v in at] for i in moved])
            for i, values in zip(moved, (some * (block * some.transpose())).tolist(), strict=True):
                for j, value in zip(moved, values, strict=True):
                    S[i][j] += value
    return arb_mat(k, k, [value for values in S for value in values])


def ball_point(
    form: ExactProgram, working: Sequence[int], bits: int, near: UpdatedInverse | None = None
) -> KktPoint:
    """The optimum with the rows of a working set as equations, and its multipliers, as balls.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
        W.
    bits : int
        Of balls.
    near : UpdatedInverse, optional
        Of a working set that differs by few rows.

    Raises
    ------
    ZeroDivisionError
        If these do not show that the rows are independent.
    """
    rows = form.exact_rows(working)
    A = columns(rows, slice(0, form.n))
    c = columns(rows, slice(form.n, form.n + 1))
    H_inverse, _, free, size = form.inverse(bits)
    with working_precision(bits):
        right_side = -(A * free + c)
        if near is None:
            y = delassus_matrix(form, rows, A, bits).solve(right_side, algorithm="lu")
        else:
            y = arb_mat(len(rows), 1, near.solved(working, right_side.entries()))
        net = A.transpose() * y
        x = free + H_inverse * net
        z = arb_mat(form.n + 1, 1, [*x.entries(), 1])
        return KktPoint(z, y.entries(), net, arb(1), 2.0 ** (-bits // 2) * size)


class WholeSystem:
    """The equations of :func:`ball_point` in whole numbers, K [x; y] = r.

    Multipliers are scaled by powers of two, each as its row.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
        W.
    """

    def __init__(self, form: ExactProgram, working: Sequence[int]) -> None:
        n = self.n = form.n
        k = len(working)
        cost, e = form.scaled_cost
        rows = form.scaled_rows(working)
        none = [fmpz(0)] * k
        entries: list[fmpz] = []
        for v in range(n):
            entries += cost[v * (n + 1) : v * (n + 1) + n]
            entries += [-a[v] for a, _ in rows]
        for a, _ in rows:
            entries += a[:n]
            entries += none
        self._K = fmpz_mat(n + k, n + k, entries)
        self._right = fmpz_mat(n + k, 1, [*cost[n :: n + 1], *(-a[n] for a, _ in rows)])
        self._form = form
        self._powers = [e - of_row for _, of_row in rows]

    def solution(self) -> KktPoint:
        """The point without rounding; ZeroDivisionError if rows are dependent."""
        quotients = cast("fmpq_mat", self._K.solve(self._right))
        numerators, denominator = quotients.numer_denom()  # positive
        return self._point(numerators.entries(), denominator)

    def solution_modulo(self) -> KktPoint:
        """A point whose numbers are those of the solution modulo a prime.

        A number that is a sum of them, each some halves of times, is not zero if it is not zero of
        this point modulo the prime.

        Raises
        ------
        ZeroDivisionError
            If the prime does not show that there is a solution.
        """
        z = nmod_mat(self._K, PRIME).solve(nmod_mat(self._right, PRIME))
        return self._point([fmpz(int(v)) for v in z.entries()], fmpz(1))

    def _point(self, numbers: Sequence[fmpz], denominator: fmpz) -> KktPoint:
        n = self.n
        with working_precision(EXACT):
            x = arb_mat(n, 1, [arb(v) for v in numbers[:n]])
            scaled_y = zip(numbers[n:], self._powers, strict=True)
            y = [arb(v) * arb(2) ** power for v, power in scaled_y]
            z = arb_mat(n + 1, 1, [*x.entries(), denominator])
            net = self._form.H * x - self._form.g * arb(denominator)
        return KktPoint(z, y, net, arb(denominator))


def fraction_point(form: ExactProgram, working: Sequence[int]) -> KktPoint:
    """The point of :func:`ball_point` without rounding; ZeroDivisionError if rows are dependent."""
    return WholeSystem(form, working).solution()
