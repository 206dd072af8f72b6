"""Programs of others as problems of a study, with the answers of ``exact_qp``."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from quasistatic_ref.exact.qp.answer import Answer, ExactQP, QPInfeasible
from quasistatic_ref.exact.time_limit import TimeIsUp
from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.program import Program, units_of
from quasistatic_ref.lab.study.row import Row
from quasistatic_ref.lab.study.run import measured, plan
from quasistatic_ref.lab.study.solvers import settings_of, solvers_of
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.pivots import surely_positive
from quasistatic_ref.step.standard_form import StandardForm, Units, si_units


@dataclass(frozen=True)
class Foreign:
    """A user's quadratic program as a problem of a study.

    Parameters
    ----------
    id : str
        Its name.
    answer : ExactQP, or the proof that there is none
    dial : None
        It is of no family with a dial [-].
    """

    id: str
    answer: Answer
    dial: float | None = None

    @property
    def family(self) -> str:
        """The problem's family: its name without the number at its end."""
        return self.id.rstrip("0123456789") or self.id

    @property
    def feasible(self) -> bool:
        """Whether the program has a solution."""
        return isinstance(self.answer, ExactQP)

    @cached_property
    def program(self) -> Program:
        """The program's matrices, with rows A x >= b, equations first."""
        problem = self.answer.problem
        rows = problem.rows
        return Program(
            (problem.P + problem.P.T) / 2, 0.0 - problem.q, rows.a, 0.0 - rows.c, rows.equations
        )

    @cached_property
    def units(self) -> Units:
        """The program's natural units; its own where P is not positive definite."""
        if not surely_positive(self.program.H):
            return si_units(len(self.program.g))
        return units_of(StandardForm(*self.program[:4]))

    def digits(self, x: Array) -> float:
        """Correct digits of an x, shape (n,) [-]."""
        assert isinstance(self.answer, ExactQP)
        return self.answer.digits(x)


def known(answers: Mapping[str, Answer | TimeIsUp]) -> list[Foreign]:
    """Answers of ``exact_qp``, optima and proofs of infeasibility, as problems of a study."""
    kinds = ExactQP, QPInfeasible
    return [Foreign(name, a) for name, a in answers.items() if isinstance(a, kinds)]


def rows_of(
    answers: Mapping[str, Answer | TimeIsUp],
    solvers: Sequence[str],
    settings: Sequence[str],
    units: str,
) -> list[Row]:
    """The rows of a study of some answers in some units, measured here and written nowhere."""
    chosen = solvers_of(solvers)
    return [
        row
        for solver in chosen
        for row in measured(
            plan(known(answers), [solver], settings_of(settings), [units]), Limits()
        )
    ]
