"""Systems of linear inequalities in integers: a solution without rounding, or a proof of none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from flint import arb_mat, fmpq, fmpz_mat
from numpy.typing import NDArray
from scipy.optimize import nnls

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.form import ExactForm, MatrixForm, whole_numbers
from quasistatic_ref.step.arrays import Indices, Mask
from quasistatic_ref.tolerances import FEASIBLE

Integers: TypeAlias = "NDArray[np.object_]"


@dataclass(frozen=True, eq=False)
class System:
    """The inequalities C z >= d, of which some are equations.

    Parameters
    ----------
    C : ndarray of int, shape (k, w)
        Python integers of any length.
    d : ndarray of int, shape (k,)
    equal : ndarray of bool, shape (k,)
        Which are equations.
    scale : ndarray of int, shape (w,)
        Exponents of the powers of two that entries of a solution are about as large as.
    """

    C: Integers
    d: Integers
    equal: Mask
    scale: Indices

    def with_equations(self, C: Integers, d: Integers) -> System:
        """The system with more equations, shapes (e, w) and (e,)."""
        return replace(
            self,
            C=np.concatenate([self.C, C]),
            d=np.concatenate([self.d, d]),
            equal=np.concatenate([self.equal, np.ones(len(d), dtype=bool)]),
        )

    @cached_property
    def inequalities(self) -> tuple[Integers, Integers]:
        """The same without equations: each is two inequalities, the second ones at the end."""
        C = np.concatenate([self.C, -self.C[self.equal]])
        d = np.concatenate([self.d, -self.d[self.equal]])
        return C, d

    @cached_property
    def guess(self) -> tuple[bool, list[int]]:
        """Whether float64 finds a solution, and which inequalities the shortest has no slack in.

        The shortest solution is that of the least-squares problem min |E y - e|, y >= 0, with E =
        [C d]' and e the last unit vector (Lawson and Hanson 1974, chapter 23); without a solution y
        is a Farkas vector. Nothing is believed of it.
        """
        C, d = self.inequalities
        with np.errstate(over="ignore"):
            rows = np.ldexp(C.astype(np.float64), self.scale)
        values = d.astype(np.float64)
        if not np.isfinite(rows).all():
            return True, []
        size = np.maximum(np.abs(rows).max(axis=1, initial=0.0), np.abs(values))
        size[size == 0] = 1.0
        E = np.column_stack([rows, values]).T / size
        try:
            y, residual = nnls(E, np.eye(len(E))[-1])
        except RuntimeError:  # its iterations have an end
            return True, []
        order = np.argsort(-y, kind="stable")
        return bool(residual > FEASIBLE), [int(i) for i in order if y[i] > 0]

    def solution(self) -> list[fmpq] | None:
        """The shortest solution, in units of the scale; None if it is proved that there is none."""
        C, d = self.inequalities
        w = C.shape[1]
        weights = (1 << 2 * int(self.scale.max() - e) for e in self.scale)
        lengths = np.diag(np.array([*weights], dtype=object))
        form = MatrixForm(
            H=arb_mat(matrix(lengths)),
            g=arb_mat(w, 1),
            rows=arb_mat(matrix(np.column_stack([C, -d]))),
        )
        end = dual_active_set(form, self.guess[1])
        return None if isinstance(end, Farkas) else end.minimiser.fractions.point

    def moves(self, point: Sequence[fmpq], n: int) -> bool:
        """Whether the first n entries of some solution are not those of `point`, a solution."""
        if self._equations_determine(n):
            return False
        slack = self.C.astype(object) @ np.array(point, dtype=object) - self.d
        tight = np.array([not s for s in slack], dtype=bool)
        w = self.C.shape[1]
        # Directions into the solutions, along which an entry grows or falls at the rate 1.
        for v in range(n):
            for rate in (1, -1):
                grows = np.zeros((1, w), dtype=object)
                grows[0, v] = rate
                directions = System(
                    C=np.concatenate([self.C[tight], grows]),
                    d=np.array([0] * int(tight.sum()) + [1], dtype=object),
                    equal=np.append(self.equal[tight], False),
                    scale=self.scale - self.scale[v],
                )
                if directions.solution() is not None:
                    return True
        return False

    def _equations_determine(self, n: int) -> bool:
        """Whether the equations leave the first n entries no choice."""
        equations = self.C[self.equal]
        rank = matrix(equations).rank()
        of_others = matrix(equations[:, n:]).rank() if equations.shape[1] > n else 0
        return bool(rank - of_others == n)


def in_integers(form: ExactForm) -> tuple[Integers, Integers, Integers, Integers, fmpq]:
    """H, g, A and b of a program in integers, each times a positive factor.

    Returns
    -------
    ndarray, shapes (n, n), (n, 1), (m, n) and (m, 1)
    fmpq
        The unit of x in which they belong together [m, rad].
    """
    H, e_H = _integers(form.H)
    A, e_A = _integers(form.A)
    g, e_g = _integers(form.g)
    c, e_b = _integers(form.c)
    b = -c
    needed = [e - of for v, e, of in ((g, e_g, e_H), (b, e_b, e_A)) if v.any()]
    e = min(needed, default=0)
    shift = np.vectorize(lambda v, by: v << by if v else v, otypes=[object])
    g = shift(g, e_g - e_H - e) if g.any() else g
    b = shift(b, e_b - e_A - e) if b.any() else b
    return H, g, A, b, fmpq(2) ** e


def _integers(M: arb_mat) -> tuple[Integers, int]:
    """Exact numbers as integers times a power of two, whose exponent is the second."""
    numbers = M.entries()
    least = min((int(v.man_exp()[1]) for v in numbers if not v.is_zero()), default=0)
    whole = [int(v) for v in whole_numbers(numbers)]
    return np.array(whole, dtype=object).reshape(M.nrows(), M.ncols()), least


def matrix(m: Integers) -> fmpz_mat:
    """The same integers, of any unit [-], shape (rows, columns)."""
    return fmpz_mat(m.shape[0], m.shape[1], m.ravel().tolist())
