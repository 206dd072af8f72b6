r"""Multipliers on working sets that differ by few rows, in balls.

Let G be the inverse of :math:`S = A H^{-1} A^T` over the rows of one working set, the base. On
another one the rows E have entered and the rows D have left. What S y = r comes to there is
:math:`y = G r - U t`: a column of U for each row of E, :math:`G A H^{-1} a_e^T`, and for each of D
its column of G. The few t follow from the equations of E and from y_D = 0. So a set costs products
with columns, where a solution of its own takes the cube of its size.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from flint import arb, arb_mat

from quasistatic_ref.certify.form import PRECISION, ExactForm, columns
from quasistatic_ref.numbers.precision import working_precision

FEW = 4
"""Rows that may enter and leave a base of any size, beside a quarter of its rows."""


class Pull(NamedTuple):
    """What a row does to a base.

    Parameters
    ----------
    a, moved : arb_mat
        The row, shape (1, n), and H^-1 a', shape (n, 1).
    loads, changes : list of arb
        A H^-1 a' and G A H^-1 a' of the rows A of the base.
    """

    a: arb_mat
    moved: arb_mat
    loads: list[arb]
    changes: list[arb]


class NearSets:
    """Solves for the multipliers on a base and on working sets near it.

    Parameters
    ----------
    form : ExactForm
    base : sequence of int
        Independent rows.

    Raises
    ------
    ZeroDivisionError
        If balls do not show that they are independent.
    """

    def __init__(self, form: ExactForm, base: Sequence[int]) -> None:
        self.form = form
        self._place = {i: place for place, i in enumerate(base)}
        self._A = columns(form.exact_rows(base), slice(0, form.n))
        with working_precision(PRECISION):
            self._G = (self._A * (form.H_inverse * self._A.transpose())).inv()
        self._G_rows = self._G.tolist()
        self._pulls: dict[int, Pull] = {}

    def has_near(self, working: Sequence[int]) -> bool:
        """Whether a working set differs by few rows."""
        return len({*working} ^ {*self._place}) <= FEW + len(self._place) // 4

    def pull(self, i: int) -> Pull:
        """What a row does to the base."""
        if i not in self._pulls:
            a = columns(self.form.exact_rows([i]), slice(0, self.form.n))
            with working_precision(PRECISION):
                moved = self.form.H_inverse * a.transpose()
                loads = self._A * moved
                self._pulls[i] = Pull(a, moved, loads.entries(), (self._G * loads).entries())
        return self._pulls[i]

    def loads(self, working: Sequence[int], p: int) -> list[arb]:
        """A_W H^-1 a_p'."""
        pull = self.pull(p)
        place = self._place
        with working_precision(PRECISION):
            return [
                pull.loads[place[i]] if i in place else self._between(i, [p])[0] for i in working
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
        with working_precision(PRECISION):
            y = self._G * y
            if entered or left:
                changes = [self._G_rows[j] for j in left] + [self.pull(i).changes for i in entered]
                U = arb_mat(changes).transpose()
                loads = [self._unit(j) for j in left] + [self.pull(i).loads for i in entered]
                equations = arb_mat(loads)
                r = [arb(0)] * len(left) + [right[i] for i in entered]
                own = [[arb(0)] * len(left) + self._between(i, entered) for i in entered]
                C = arb_mat([[arb(0)] * len(r)] * len(left) + own)
                few = (C - equations * U).solve(arb_mat(len(r), 1, r) - equations * y)
                y -= U * few
                t = few.entries()[len(left) :]
        found = dict(zip((*place, *entered), (*y.entries(), *t), strict=True))
        return [found[i] for i in working]

    def _unit(self, j: int) -> list[arb]:
        return [arb(int(j == k)) for k in range(len(self._place))]

    def _between(self, i: int, rows: Sequence[int]) -> list[arb]:
        """The a_i H^-1 a' of some rows."""
        a = self.pull(i).a
        return [(a * self.pull(other).moved)[0, 0] for other in rows]
