"""What proves the optimum of a step, whichever backend has answered, and measures that answer."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from quasistatic_ref.certify.exact import ExactOptimum, step_optimum
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.parts import needing
from quasistatic_ref.solve.backends import RESIDUAL
from quasistatic_ref.solve.units import StepInBothUnits
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from quasistatic_ref.solve.solver import NaturalAnswer


class Prover:
    """The exact method. Its optimum does not depend on where it starts.

    What the backend claims is not read: its answer is a guess of the active rows.
    """

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum, sought from where an answer shows it to be, or from cold.

        Raises
        ------
        StepInfeasible, StepIllPosed
        """
        warm = []
        if answer is not None:
            form = both.natural_form
            warm = warm_rows(form.A, answer.natural_lam, form.A @ answer.natural_delta_q - form.b)
        return step_optimum(both.si_step, warm)

    def error_bound(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """A rigorous bound of the relative error [-] of delta_q (n_v,), lam (m,) in SI units.

        Infinite where none is known, as in a curved cone.
        """
        if not cone(both.si_step.cone).polyhedral:
            return math.inf
        with needing(RESIDUAL):
            from quasistatic_ref.optional.large.bound import error_bound
        return error_bound(both.si_step, delta_q, lam)


class OnwardProver(Prover):
    """The exact method, from the working set of the step before: it needs no answer."""

    def __init__(self) -> None:
        self._before: tuple[int, ...] = ()

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum; an `answer` is not looked at. Errors are those of the base."""
        optimum = step_optimum(both.si_step, self._before)
        self._before = optimum.working_set
        return optimum
