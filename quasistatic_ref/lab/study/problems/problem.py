"""One quadratic program of contact: its numbers without zeros, its answer, what is known of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from quasistatic_ref.certify.norm import digits_of_error, energy_norm, error_length
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.step.units import Units

QP, SOCP = "qp", "socp"
"""Rows A x >= b; or blocks of four, (A x - b)_0 >= |(A x - b)_1:3|."""
OPTIMAL = "optimal"
INFEASIBLE = "infeasible"
EXACT = "exact"
"""An answer that is rounded correctly."""
ENCLOSED = "enclosed"
"""An answer that is off by rounding at most."""


@dataclass(frozen=True, eq=False)
class Answer:
    """What is known of a solution.

    Parameters
    ----------
    kind : str
        ``"exact"`` or ``"enclosed"``.
    error : float
        ||x - x*||_H / ||H^-1 g||_H is at most that [-]; 0.0 where only rounding is between.
    x, net : ndarray, shape (n,)
        The optimum [m, rad], and A'lam [N s, N m s].
    slack, lam : ndarray, shape (m,)
        A x - b [m], and multipliers [N s], which are one choice of many.
    farkas : mapping of int to str
        Of an infeasible problem, in place of the rest: y_i > 0 by row as ``"p/q"``, with A'y = 0
        and b'y > 0 without rounding.
    walks : int
        Rows that the exact method added to those it began with; 0 where it was not used.
    unique, differentiable : bool or None
        Whether lam is the only one, and x is differentiable with respect to g; None: not known.
    """

    kind: str
    error: float
    x: Array
    net: Array
    slack: Array
    lam: Array
    farkas: Mapping[int, str]
    walks: int = 0
    unique: bool | None = None
    differentiable: bool | None = None

    @property
    def status(self) -> str:
        """``"optimal"`` or ``"infeasible"``."""
        return INFEASIBLE if self.farkas else OPTIMAL


@dataclass(frozen=True, eq=False)
class Problem:
    """min 1/2 x'Hx - g'x subject to A x >= b, or to cones, in SI units.

    Parameters
    ----------
    facts : mapping
        Its line of ``problems.jsonl``.
    H, A : csr_matrix, shapes (n, n) and (m, n)
    g, b : ndarray, shapes (n,) and (m,)
    units : Units
        Natural ones, powers of two: part of the set, so that they are the same everywhere.
    answer : Answer
        In SI units.
    """

    facts: Mapping[str, Any]
    H: csr_matrix
    g: Array
    A: csr_matrix
    b: Array
    units: Units
    answer: Answer

    @property
    def id(self) -> str:
        """Its name."""
        return str(self.facts["id"])

    @property
    def family(self) -> str:
        """The family that it is of."""
        return str(self.facts["family"])

    @property
    def dial(self) -> float | None:
        """Where the family's dial stands [the dial's unit]; None: the family has none."""
        dial = self.facts["dial"]
        return None if dial is None else float(dial)

    @property
    def feasible(self) -> bool:
        """Whether it has a solution."""
        return not self.answer.farkas

    @property
    def error_length(self) -> float:
        """The length that errors are divided by, in the norm of H [(N m s)^0.5].

        It is ``length`` in the line of the problem, which was made of a step. Where that is
        missing, it is formed without what each load asks for alone.
        """
        if "length" in self.facts:
            return float(self.facts["length"])
        x = self.answer.x if self.feasible else np.zeros(len(self.g))
        return error_length(self.H.toarray(), self.g, x)

    @property
    def natural(self) -> "Problem":
        """The same in natural units, without rounding; Farkas vectors are those of SI units."""
        S = self.units.coordinate
        ell = self.units.length
        rho = self.units.size
        a = self.answer
        one = Units(np.ones(len(S)), 1.0, 1.0)
        lam_unit = ell / rho
        if a.farkas:
            answer = a
        else:
            slack = a.slack / (rho * ell)
            lam = a.lam * lam_unit
            answer = Answer(a.kind, a.error, a.x / (rho * S), a.net * S / rho, slack, lam, {},
                            a.walks, a.unique, a.differentiable)  # fmt: skip
        H = csr_matrix(self.H.multiply(S).multiply(S[:, None]))
        A = csr_matrix(self.A.multiply(S / ell))
        g = self.g * (S / rho)
        b = self.b / (rho * ell)
        facts = dict(self.facts) | {"length": self.error_length / rho}
        return Problem(facts, H, g, A, b, one, answer)

    @property
    def form(self) -> StandardForm:
        """H, g, A, b as arrays."""
        return StandardForm(self.H.toarray(), self.g, self.A.toarray(), self.b)

    @cached_property
    def program(self) -> Program:
        """H, g, A, b as arrays; InputError if its rows are cones."""
        if self.facts["kind"] != QP:
            raise InputError("has cones; studies contain rows only", value=self.id)
        return Program(*self.form)

    def digits(self, x: Array) -> float:
        """Correct digits of an x, shape (n,), in SI units [-]; if there is a solution."""
        S = self.units.coordinate
        H = csr_matrix(self.H.multiply(S).multiply(S[:, None]))
        error = energy_norm(H.toarray()).of_displacement((x - self.answer.x) / S)
        return digits_of_error(error / self.error_length)
