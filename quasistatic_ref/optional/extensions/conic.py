r"""Optimality conditions of a conic program as residuals: the judge of extended steps.

.. math:: \min \tfrac12 x^T P x + c^T x \quad\text{s.t.}\quad A x + s = b,\; s \in K

has the conditions P x + c + A'z = 0, s in K, z in the dual cone, s'z = 0 (by blocks). K is made
of {0}, s >= 0, second-order cones, and exponential cones cl{(u, v, w) : v exp(u / v) <= w, v > 0}.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import Violations
from quasistatic_ref.step.standard_form import StandardForm


@dataclass(frozen=True, eq=False)
class ConicProgram:
    """A conic program in float64.

    Parameters
    ----------
    P : ndarray, shape (n, n)
        Symmetric.
    c : ndarray, shape (n,)
        The linear part of the objective [that of the program].
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)
    zero, nonnegative : int
        Number of rows of each kind, in this order.
    second_order : sequence of int
        Sizes of the second-order cones, which come next.
    exponential : int
        Number of exponential cones, three rows each, which come last.
    """

    P: Array
    c: Array
    A: Array
    b: Array
    zero: int
    nonnegative: int
    second_order: Sequence[int]
    exponential: int

    def violations(self, s: Array, z: Array) -> Violations:
        """Violations of the cones by s and z, in the form of `row_violations`.

        Parameters
        ----------
        s, z : ndarray, shape (m,)
            Slacks b - A x and multipliers [those of the program].
        """
        ends = np.cumsum([self.zero, self.nonnegative, *self.second_order, *[3] * self.exponential])
        flat, rows, *parts = np.split(s, ends[:-1])
        _, multipliers, *duals = np.split(z, ends[:-1])
        k = len(self.second_order)
        short = [np.abs(flat), -rows]
        short += [*map(_outside_ball, parts[:k]), *map(_outside, parts[k:])]
        pull = [-multipliers]
        pull += [*map(_outside_ball, duals[:k]), *map(_outside_dual, duals[k:])]
        work = [rows * multipliers]
        work += [np.array([u @ v]) for u, v in zip(parts, duals, strict=True)]
        return np.concatenate(short), np.concatenate(pull), np.concatenate(work)


def conic_program(data: Mapping[str, Any]) -> ConicProgram:
    """The program in the data that CVXPY makes for Clarabel or SCS."""
    dims = data["dims"]
    n = len(data["c"])
    P = data["P"].toarray() if data.get("P") is not None else np.zeros((n, n))
    return ConicProgram(
        P=np.triu(P) + np.triu(P, 1).T,
        c=data["c"],
        A=data["A"].toarray(),
        b=data["b"],
        zero=int(dims.zero),
        nonnegative=int(dims.nonneg),
        second_order=[int(k) for k in dims.soc],
        exponential=int(dims.exp),
    )


def conic_residuals(program: ConicProgram, x: Array, z: Array) -> Residuals:
    """Largest violation of each condition at an answer.

    Parameters
    ----------
    program : ConicProgram
    x : ndarray, shape (n,)
    z : ndarray, shape (m,)
        Multipliers, in the dual cone [those of the program].

    Returns
    -------
    Residuals
    """
    form = StandardForm(program.P, -program.c, -program.A, -program.b)
    return optimality_residuals(form, x, z, program.violations)


def _outside_ball(s: Array) -> Array:
    return np.array([np.linalg.norm(s[1:]) - s[0]])


def _outside(s: Array) -> Array:
    """How far s is outside of an exponential cone, along its third coordinate."""
    u, v, w = s
    if v > 0:
        with np.errstate(over="ignore"):
            return np.array([v * np.exp(u / v) - w])
    return np.array([max(u, -v, -w)])


def _outside_dual(z: Array) -> Array:
    """How far z is outside of the dual cone {(u, v, w) : (u - v, -u, w) in the cone}."""
    u, v, w = z
    return _outside(np.array([u - v, -u, w]))
