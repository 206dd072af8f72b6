"""Systems of linear inequalities in integers: a solution without rounding, or a proof of none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from flint import fmpq, fmpz_mat
from numpy.typing import NDArray
from scipy.optimize import nnls

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.rational import ExactForm, matrix
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
        one = fmpq(1)
        form = ExactForm(
            H=matrix(lengths),
            g=fmpz_mat(w, 1),
            A=matrix(C),
            b=matrix(d[:, None]),
            x_unit=one,
            slack_unit=one,
            lam_unit=one,
            net_unit=one,
        )
        end = dual_active_set(form, self.guess[1])
        return None if isinstance(end, Farkas) else end.minimiser.rational.point

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
