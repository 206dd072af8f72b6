"""One quadratic program of contact: its numbers without zeros, its answer, what is known of it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from scipy.sparse import csr_matrix

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.digits import digits_of_error
from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.standard_form import StandardForm, Units, si_units

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
    """The exact solution of a problem, or the proof that there is none.

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
    """

    kind: str
    error: float
    x: Array
    net: Array
    slack: Array
    lam: Array
    farkas: Mapping[int, str]

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
        """The problem's name."""
        return str(self.facts["id"])

    @property
    def family(self) -> str:
        """The name of the problem's family."""
        return str(self.facts["family"])

    @property
    def dial(self) -> float | None:
        """Where the family's dial stands [the dial's unit]; None: the family has none."""
        dial = self.facts["dial"]
        return None if dial is None else float(dial)

    @property
    def feasible(self) -> bool:
        """Whether the problem has a solution."""
        return not self.answer.farkas

    @property
    def error_length(self) -> float:
        """The length that errors are divided by, in the norm of H [(N m s)^0.5]."""
        return float(self.facts["length"])

    @cached_property
    def natural(self) -> "Problem":
        """The problem in natural units, without rounding; its Farkas vector stays in SI units."""
        S, ell, rho = self.units
        answer = self.answer
        if self.feasible:
            answer = replace(
                answer,
                x=answer.x / (rho * S),
                net=answer.net * S / rho,
                slack=answer.slack / (rho * ell),
                lam=answer.lam * (ell / rho),
            )
        return replace(
            self,
            facts={**self.facts, "length": self.error_length / rho},
            H=csr_matrix(self.H.multiply(S).multiply(S[:, None])),
            g=self.g * (S / rho),
            A=csr_matrix(self.A.multiply(S / ell)),
            b=self.b / (rho * ell),
            units=si_units(len(S)),
            answer=answer,
        )

    @cached_property
    def form(self) -> StandardForm:
        """H, g, A, b as arrays."""
        return StandardForm(self.H.toarray(), self.g, self.A.toarray(), self.b)

    @property
    def program(self) -> Program:
        """H, g, A, b as arrays; InputError if its rows are cones."""
        if self.facts["kind"] != QP:
            raise InputError("has cones; studies contain rows only", value=self.id)
        return Program(*self.form)

    def digits(self, x: Array) -> float:
        """Correct digits of an x, shape (n,), in SI units [-]; if there is a solution."""
        natural = self.natural
        off = x / (self.units.size * self.units.coordinate) - natural.answer.x
        error = energy_norm(natural.form.H).of_displacement(off)
        return digits_of_error(error / natural.error_length)
